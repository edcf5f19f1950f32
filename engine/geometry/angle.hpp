// The angle of two directions, exact for small ones and for those that are nearly opposite too.
#pragma once

#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

/// Radians, 0 to π; of any lengths.
inline double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace impinge
