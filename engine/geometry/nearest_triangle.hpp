// The triangle of a surface that is nearest to a point, by its tree of boxes.
#pragma once

#include <span>

#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {

struct NearestTriangle {
  int triangle = -1;  ///< none: the surface has no triangles
  PointTriangle at;   ///< where on it; infinitely far if there is none
};

/// `vertices`: where the corners stand; `fitted`: the tree's boxes there, by node (BoxTree::fit), empty where the tree
/// was made for them; `guess`: a triangle that may be near, -1 if nothing is known. The nearer it is, the quicker.
NearestTriangle nearest_triangle(const BoxTree& tree, std::span<const Triangle> triangles,
                                 std::span<const Vec3> vertices, const Vec3& x, std::span<const Aabb> fitted = {},
                                 int guess = -1);

}  // namespace impinge
