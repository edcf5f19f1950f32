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
  return std::none_of(bodies_.active().begin(), bodies_.active().end(),
                      [&](BodyIndex b) { return bodies_[b].is_moving() || is_driven(bodies_[b], time_); });
}

/// Frames in which a part of it doesn't move cost what the rest of it does.
void World::let_rest() {
  if (!is_published_) bodies_.activate_all();
  is_published_ = false;
  bodies_.let_rest([&](const Body& body) { return !body.is_moving() && !is_driven(body, time_); });
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
  state_.set_time(frame_, time_);
  hash_is_due_ = true;
}

const StepRecord& World::record() const {
  const std::lock_guard lock(hash_mutex_);
  if (hash_is_due_) record_.stats.state_hash = state_.hash();
  hash_is_due_ = false;
  return record_;
}

}  // namespace impinge
