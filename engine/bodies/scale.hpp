// Speeds and times that belong to a length under gravity, as Froude's similarity has them: what falls through a length
// takes that time and reaches that speed, but for a factor √2.
#pragma once

#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

inline constexpr double kStandardGravity = 9.80665;  ///< m/s²

/// The acceleration that thresholds go by, m/s², of the scene's gravity: without any, nothing falls, and that of the
/// earth stands for it.
inline double scale_gravity(const Vec3& gravity) {
  const double g = gravity.norm();
  return g > 0.0 ? g : kStandardGravity;
}

/// √(g·length), m/s.
inline double speed_scale(double gravity, double length) { return std::sqrt(gravity * length); }
/// √(length/g), s.
inline double time_scale(double gravity, double length) { return std::sqrt(length / gravity); }

}  // namespace impinge
