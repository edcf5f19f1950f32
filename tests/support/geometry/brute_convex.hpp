// Distance and depth of two convex polyhedra over all their features, in extended precision: slow, and without any idea
// in common with the engine's tests of convex solids.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge::test {

struct BruteGap {
  double gap = 0.0;  ///< distance, or minus the least overlap
  bool overlaps = false;
};

/// Of two closed convex surfaces in one frame. Distance: all vertex-face and edge-edge pairs. Depth: the least overlap
/// along all face normals and all cross products of two edges.
BruteGap brute_convex_gap(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace impinge::test
