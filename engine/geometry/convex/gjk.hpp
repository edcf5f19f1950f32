// The distance of two convex sets that do not overlap. [Gilbert88, VanDenBergen99]
#pragma once

#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

struct GjkResult {
  bool apart = false;                   ///< else they overlap or touch (to 1e-13 of their size)
  double distance = 0.0;                ///< of the cores if apart
  std::array<MinkowskiPoint, 4> point;  ///< the simplex that holds the nearest point, or the origin
  int count = 0;
  Vec3 nearest = Vec3::Zero();  ///< point of the difference nearest to the origin
  double size = 0.0;            ///< largest |w| seen, metres: what rounding compares with
};

/// Stops early, with a distance that is too large, once it is certain to exceed `reach`.
GjkResult gjk(const MinkowskiDifference& difference, double reach = 1e300);

}  // namespace impinge
