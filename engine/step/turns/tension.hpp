// What is pulled taut swings across the pull the faster the lighter it is, and faster than sub-steps see where what hangs on it
// weighs enough: rows, whose directions are those of the sub-step's start, then kick it from side to side, farther each time.
#pragma once

#include <vector>

#include "engine/contact/group_system.hpp"

namespace impinge {

struct SlowedBody {
  std::size_t block = 0;                ///< of GroupSystem::rigid
  Mat3 inverse_inertia = Mat3::Zero();  ///< that it has by itself
};

/// Gives bodies of the group that are pulled by what their rows start from (GroupSystem::lambda) as much inertia across the pull
/// as sub-steps of that length can follow. A force f that pulls outwards at an arm r is stiff against turns about other axes by
/// f·r, K = (f·r)(1 - r rᵀ/r²); where both lie on one line that is the geometric stiffness of a constraint [Tournier15],
/// [Andrews17]. What sub-steps can follow stays as it is. Returns the others.
std::vector<SlowedBody> slow_taut_bodies(GroupSystem& system, double time_step);

}  // namespace impinge
