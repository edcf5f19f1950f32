// The least overlap of two convex sets: a polytope inside their difference grows towards the nearest point of its
// surface (EPA). [VanDenBergen01]
#pragma once

#include "engine/geometry/convex/gjk.hpp"

namespace impinge {

struct PolytopeResult {
  Vec3 direction = Vec3::UnitY();      ///< unit, from b to a: moved along it by the depth a touches b
  double depth = 0.0;                  ///< of the cores along it: an upper bound of the least overlap, and attained
  double least = 0.0;                  ///< the least overlap is no smaller, up to rounding
  std::array<MinkowskiPoint, 3> face;  ///< where the polytope's nearest facet has its corners
  bool has_volume = true;              ///< false: the difference of the sets is flat; the direction is across it
};

/// From the simplex that GJK ended with. Stops when depth and least agree to `tolerance` times the size, or after
/// `most_steps`.
PolytopeResult expand_polytope(const MinkowskiDifference& difference, const GjkResult& start, double tolerance,
                               int most_steps);

}  // namespace impinge
