// The signed gap of two convex solids: their distance where they are apart, the least overlap where they are not, with
// the direction and the points. Polyhedra to rounding, curved solids to 1e-9 of their size as a rule.
#pragma once

#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

struct ConvexGap {
  double gap = 0.0;             ///< metres; negative: they overlap, and moving a by -gap along the normal parts them
  Vec3 normal = Vec3::UnitY();  ///< unit, from b towards a
  Vec3 point_a = Vec3::Zero();  ///< on a's surface, world
  Vec3 point_b = Vec3::Zero();  ///< on b's surface; point_a - point_b = gap * normal up to rounding
  bool is_within_reach = true;  ///< false: farther apart than asked for; the rest is then not worked out
};

/// `reach`: metres; beyond it nothing but the answer that it is is wanted.
ConvexGap convex_gap(const PlacedConvex& a, const PlacedConvex& b, double reach = 1e300);

}  // namespace impinge
