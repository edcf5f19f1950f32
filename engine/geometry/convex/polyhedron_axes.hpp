// Two convex polyhedra along their separating axes: the normals of both's faces and the common normals of their edges,
// one of which is the direction of least overlap. [Gottschalk96]
#pragma once

#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

struct SeparatingAxis {
  Vec3 direction = Vec3::UnitY();  ///< unit, from b to a
  double separation = -1e300;      ///< metres along it; negative: overlap
};

/// Number of edge pairs that best_axis looks at.
inline double axis_work(const MinkowskiDifference& d) {
  return static_cast<double>(d.polyhedron_a()->edges().size()) * static_cast<double>(d.polyhedron_b()->edges().size());
}

/// The axis of largest separation of all. Of two edges only those count whose faces' normals cross on the Gauss map
/// [Gregorius13]: no others touch in parallel motion. Faces come before edges within `tie` metres.
SeparatingAxis best_axis(const MinkowskiDifference& difference, double tie);

/// The best axis among the faces and edges that meet in the given corners (-1: none) and lie within half a degree of
/// `direction`; of separation -1e300 if there is none.
SeparatingAxis nearby_axis(const MinkowskiDifference& difference, std::span<const MinkowskiPoint> corners,
                           const Vec3& direction);

}  // namespace impinge
