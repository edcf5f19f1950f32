// Stages 5 and 6 of a sub-step together: a sleeper that is touched wakes with its island, which may touch more.
#pragma once

#include "engine/bodies/time_integration.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/step/sleeping.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// What contacts are found by.
struct Detecting {
  const ContactSettings& contact;
  BroadPhase& broad_phase;
  NarrowPhase& narrow_phase;
  /// Of pairs with an exact shape: as ContactQuery has it, for responses that nothing is sought for anew.
  bool either_may_stop = false;
};

/// Fills pairs, triangle pairs and collisions. The woken fall freely like all others in this sub-step.
void detect(Bodies& bodies, std::span<const Attachment> attachments, const Detecting& by, const TimeIntegration& how,
            Sleeping& sleeping, SubStep& step, StageTimes& times);

}  // namespace impinge
