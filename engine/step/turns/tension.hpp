// What is pulled taut swings across the pull the faster the lighter it is, and faster than sub-steps see where what hangs on it
// weighs enough: rows, whose directions are those of the sub-step's start, then kick it from side to side, farther each time.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

/// Gives bodies of the group that are pulled by what their rows start from (GroupSystem::lambda) as much inertia across the pull
/// as sub-steps of that length can follow, by K = (f·r) 1 - (f rᵀ + r fᵀ)/2 of a force f at an arm r, the stiffness that
/// the pull has against turns [Tournier15], [Andrews17]. What sub-steps can follow stays as it is.
/// Whether there was anything else.
bool slow_taut_bodies(GroupSystem& system, double time_step);

}  // namespace impinge
