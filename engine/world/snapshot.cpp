// The full state as bytes: what makes the next frame, and what the last one showed; nothing that can be derived from
// these.
#include "engine/world/snapshot.hpp"

#include "engine/core/archive.hpp"
#include "engine/ledger/ledger.hpp"
#include "engine/step/sub_step.hpp"
#include "engine/world/step_record_archive.hpp"
#include "engine/world/world.hpp"

namespace impinge {

void StateBytes::take(int frame, double time, const Bodies& bodies, const ContactCache& cache,
                      const Sleeping& sleeping) {
  frame_ = frame, time_ = time;
  cache_ = cache, sleeping_ = sleeping;
  const auto take_all = [&] {
    ByteWriter out(std::move(bodies_));
    begin_.assign(1, 0);
    for (BodyIndex b(0); b < bodies.present(); ++b) bodies[b].save(out), begin_.push_back(out.bytes().size());
    bodies_ = out.take();
  };
  const std::size_t present = static_cast<std::size_t>(bodies.present().value());
  if (bodies.all_active() || begin_.size() != present + 1) return take_all();
  ByteWriter one;
  for (const BodyIndex b : bodies.active()) {
    if (b >= present) break;
    one = ByteWriter(one.take());
    bodies[b].save(one);
    if (one.bytes().size() != of(b).size()) return take_all();  // of velocities of the middle, where a body gets some
    bodies_.replace(begin_[b], one.bytes().size(), one.bytes());
  }
}

std::string_view StateBytes::of(BodyIndex body) const {
  return std::string_view(bodies_).substr(begin_[body], begin_[body + 1] - begin_[body]);
}

void StateBytes::write(ByteWriter& out) const {
  out.put(frame_);
  out.put(time_);
  out.put(static_cast<std::uint64_t>(begin_.size() - 1));
  out.put_bytes(bodies_.data(), bodies_.size());
  cache_.save(out);
  sleeping_.save(out);
}

std::uint64_t StateBytes::hash() const {
  ByteWriter all;
  write(all);
  return hash_bytes(all.bytes());
}

void World::save_state(ByteWriter& out) const {
  StateBytes now;
  now.take(frame_, time_, bodies_, cache_, sleeping_);
  now.write(out);
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
  look_at_all();
  cache_.restore(in);
  sleeping_.restore(in);
  stats_ = {};
  unsafe_.clear();
  *sub_step_ = {};  // the record says what was found
  publish_found();
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
