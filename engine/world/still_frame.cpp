// Frames in which nothing moves. Where all that has freedom sleeps and nothing is driven, a frame leaves every body, every
// remembered impulse and every figure as it was, but for its number and the time. So once one was made in full, the next
// ones are that one with another number, until something moves or is changed.
#include <algorithm>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/scripted_body.hpp"
#include "engine/core/archive.hpp"
#include "engine/step/sub_step.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

/// Whether the body is driven in the coming frame, or may be.
bool is_driven(const Body& body, double time) {
  if (body.deleted) return false;
  switch (body.kind()) {
    case BodyKind::scripted: {
      const Motion& motion = body.as<ScriptedBody>()->motion;
      return !motion.is_empty() && time < motion.keys().back().time;
    }
    case BodyKind::deformable: {
      const std::vector<HeldRegion>& held = body.as<DeformableBody>()->held;
      return std::any_of(held.begin(), held.end(), [](const HeldRegion& region) { return region.is_moved(); });
    }
    default:
      return false;
  }
}

}  // namespace

bool World::is_still() const {
  for (const Body& body : bodies_)
    if (body.is_moving() || is_driven(body, time_)) return false;
  return true;
}

void World::repeat_still_frame() {
  FrameStats& stats = record_.stats;
  stats.times = {};
  {
    const StageTimer timer(stats.times.step_ms);
    ++frame_;
    for (int i = 0; i < parameters.simulation.substeps; ++i) sub_step_->time = time_, time_ += sub_step_->time_step;
  }
  stats.frame = frame_;
  stats.time = time_;
  // the state begins with these two (save_state)
  ByteWriter begin;
  begin.put(frame_), begin.put(time_);
  state_.replace(0, begin.bytes().size(), begin.bytes());
  hash_is_due_ = true;
}

const StepRecord& World::record() const {
  const std::lock_guard lock(hash_mutex_);
  if (hash_is_due_) record_.stats.state_hash = hash_bytes(state_);
  hash_is_due_ = false;
  return record_;
}

}  // namespace impinge
