// Stages 5 and 6 of a sub-step together: a sleeper that is touched wakes with its island, which may touch more.
#pragma once

#include "engine/bodies/time_integration.hpp"
#include "engine/step/find_collisions.hpp"
#include "engine/step/sleeping.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Fills pairs, triangle pairs and collisions. The woken fall freely like all others in this sub-step.
void detect(Bodies& bodies, std::span<const Attachment> attachments, const Detecting& by, const TimeIntegration& how,
            Sleeping& sleeping, SubStep& step, StageTimes& times);

/// Where others have come to touch one of two that meet in flight, the contacts take their place again that the two had from
/// where the sub-step begins: impulses that act at different times keep no angular momentum.
void end_flights(const Bodies& bodies, SubStep& step);

}  // namespace impinge
