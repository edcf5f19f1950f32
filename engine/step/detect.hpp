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

}  // namespace impinge
