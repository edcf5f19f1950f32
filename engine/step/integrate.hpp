// Stage 11 of a sub-step: bodies take the velocities that contact left, and move by them.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Adds each group's change of velocity to its bodies.
void change_velocities(Bodies& bodies, const SubStep& step);

/// Moves the bodies by their velocities to the end of the sub-step. Threads share them; throws DivergenceError, without a
/// frame, as the next one does.
void advance(Bodies& bodies, const TimeIntegration& how, const SubStep& step);

/// Moves them out of overlap, and closes the motion. Throws for the lowest body whose state is no longer finite.
void push_out(Bodies& bodies, const SubStep& step);

}  // namespace impinge
