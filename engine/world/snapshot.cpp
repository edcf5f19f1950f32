// The full state as bytes: what makes the next frame, and what the last one showed; nothing that can be derived from
// these.
#include "engine/core/archive.hpp"
#include "engine/ledger/ledger.hpp"
#include "engine/step/sub_step.hpp"
#include "engine/world/step_record_archive.hpp"
#include "engine/world/world.hpp"

namespace impinge {

void World::save_state(ByteWriter& out) const {
  out.put(frame_);
  out.put(time_);
  std::uint64_t present = 0;
  for (const Body& body : bodies_) present += body.absent ? 0 : 1;
  out.put(present);
  for (const Body& body : bodies_)
    if (!body.absent) body.save(out);
  cache_.save(out);
  sleeping_.save(out);
}

void World::save(ByteWriter& out) const {
  save_state(out);
  put_record(out, record());
}

void World::restore(ByteReader& in) {
  frame_ = in.get<int>();
  time_ = in.get<double>();
  const std::uint64_t size = static_cast<std::uint64_t>(bodies_.size().value()), present = in.get<std::uint64_t>();
  if (present > size || present + starts_.size() < size)
    throw InputError("snapshot: it belongs to a scene with another number of bodies");
  for (std::uint64_t b = 0; b < size; ++b) {
    Body& body = bodies_[b];
    body.absent = body.deleted = b >= present;
    if (body.absent) continue;
    body.restore(in);
    body.update_world_vertices();
  }
  cache_.restore(in);
  sleeping_.restore(in);
  stats_ = {};
  unsafe_.clear();
  *sub_step_ = {};  // the record says what was found
  publish_found();
  was_still_ = false;
  if (ledger_) ledger_->forget_acts();
  settings_seen_ = settings();
  const std::uint64_t hash = record().stats.state_hash;
  get_record(in, record_);
  if (record_.stats.state_hash != hash)
    throw InputError(
        "snapshot: its record is of another state; it is another version's or damaged, remove it and run again");
}

std::uint64_t World::state_hash() const {
  ByteWriter state;
  save_state(state);
  return hash_bytes(state.bytes());
}

}  // namespace impinge
