// The full state as bytes: what makes the next frame, and what the last one showed; nothing that can be derived from
// these.
#include "engine/core/archive.hpp"
#include "engine/world/step_record_archive.hpp"
#include "engine/world/world_stages.hpp"

namespace impinge {

void World::save_state(ByteWriter& out) const {
  out.put(frame_);
  out.put(time_);
  out.put<std::uint64_t>(bodies_.size());
  for (const RigidBody& body : bodies_) {
    out.put(body.pose.position), out.put(body.pose.rotation);
    out.put(body.velocity), out.put(body.angular_momentum), out.put(body.scripted_angular_velocity);
    out.put(body.asleep), out.put(body.rest_time), out.put(body.island);
    if (!body.soft) continue;
    const DeformableBody& fem = body.soft->fem;
    out.put(fem.acceleration_known);
    for (const HeldRegion& region : body.soft->held) out.put(region.displacement), out.put(region.wanted);
    for (const VecX* x : {&fem.position, &fem.velocity, &fem.acceleration})
      for (Eigen::Index i = 0; i < x->size(); ++i) out.put((*x)[i]);
  }
  stages_->cache.save(out);
  stages_->sleeping.save(out);
}

void World::save(ByteWriter& out) const {
  save_state(out);
  put_record(out, record_);
}

void World::restore(ByteReader& in) {
  frame_ = in.get<int>();
  time_ = in.get<double>();
  if (in.get<std::uint64_t>() != bodies_.size())
    throw InputError("snapshot: it belongs to a scene with another number of bodies");
  for (RigidBody& body : bodies_) {
    body.pose.position = in.get_vec3(), body.pose.rotation = in.get_mat3();
    body.velocity = in.get_vec3(), body.angular_momentum = in.get_vec3(),
    body.scripted_angular_velocity = in.get_vec3();
    body.asleep = in.get<bool>(), body.rest_time = in.get<double>(), body.island = in.get<int>();
    if (body.soft) {
      DeformableBody& fem = body.soft->fem;
      fem.acceleration_known = in.get<bool>();
      for (HeldRegion& region : body.soft->held) region.displacement = in.get_vec3(), region.wanted = in.get_vec3();
      for (VecX* x : {&fem.position, &fem.velocity, &fem.acceleration})
        for (Eigen::Index i = 0; i < x->size(); ++i) (*x)[i] = in.get<double>();
      interpolate(body.soft->embedding, fem.fem.rest(), fem.velocity, body.soft->surface_velocity);
    }
    body.update_world_vertices();
  }
  stages_->cache.restore(in);
  stages_->sleeping.restore(in);
  stages_->choose_linear_solver(parameters.simulation.linear_solver);
  stages_->frame_stats = {};
  stages_->detection.collisions.clear();  // the record says what was found
  publish(false);
  const std::uint64_t hash = record_.stats.state_hash;
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
