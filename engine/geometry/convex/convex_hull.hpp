// The convex hull of points in space: quickhull [Barber96] with exact orientation tests, so that coplanar, repeated and
// nearly degenerate points cannot break it.
#pragma once

#include <span>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct ConvexHull {
  TriangleMesh mesh;        ///< closed, outward; its vertices are points of the input, in their order there
  std::vector<int> source;  ///< of each vertex: which point of the input it is (the first, of equal ones)
  std::string problem;      ///< why there is no hull (the mesh is then empty), e.g. "has 3 different points"
};

/// The hull of `points` (finite, metres). Points inside, repeated, or in the middle of a face or edge are left out
/// as far as they do not happen to have become corners of its triangles. Fewer than four different points, and points
/// in one plane to 1e-10 of their extent, have no hull.
/// Expected time n log n.
ConvexHull convex_hull(std::span<const Vec3> points);

}  // namespace impinge
