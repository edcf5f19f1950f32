// A box at a pose: corners, edges, faces by number, and its signed distance.
// Numbers: corner bit k set = positive side of axis k; face 2k + (positive ? 1 : 0); edge 4k + bits of the sides of the
// two other axes in ascending order.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

struct OrientedBox {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  ///< columns: unit axes
  Vec3 half = Vec3::Zero();

  Vec3 to_local(const Vec3& x) const { return axes.transpose() * (x - center); }
  Vec3 to_world(const Vec3& local) const { return center + axes * local; }
  Vec3 corner(int i) const {
    return to_world({i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z()});
  }
  /// The two corners of an edge, negative side of its axis first.
  static std::array<int, 2> edge_corners(int edge) {
    const int axis = edge / 4, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const int base = (edge & 1 ? 1 << u : 0) | (edge & 2 ? 1 << v : 0);
    return {base, base | (1 << axis)};
  }
  /// The edge along `axis` on the sides that `corner` names.
  static int edge_of(int axis, int corner) {
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    return 4 * axis + (corner >> u & 1) + 2 * (corner >> v & 1);
  }
  /// Half the length of the box's projection onto a unit direction.
  double radius_along(const Vec3& direction) const { return (axes.transpose() * direction).cwiseAbs().dot(half); }
};

/// Where the surface of a box is nearest to a point.
struct NearestOnBox {
  double distance = 0.0;       ///< signed: negative inside
  Vec3 point = Vec3::Zero();   ///< on the surface, world
  Vec3 normal = Vec3::Zero();  ///< unit, outward; defined everywhere, also on the surface and in the centre
  std::array<int, 3> side{};   ///< -1, 0, 1 for each axis; one entry that isn't 0: face, two: edge, three: corner
  int beyond = 0;              ///< how many entries of `side` aren't 0
};

inline NearestOnBox nearest_on_box(const OrientedBox& box, const Vec3& x) {
  const Vec3 local = box.to_local(x);
  const Vec3 clamped = local.cwiseMax(-box.half).cwiseMin(box.half);
  NearestOnBox result;
  for (int k = 0; k < 3; ++k)
    if (local[k] != clamped[k]) {
      result.side[k] = local[k] > 0.0 ? 1 : -1;
      ++result.beyond;
    }
  if (result.beyond > 0) {
    const Vec3 offset = local - clamped;
    result.distance = result.beyond == 1 ? offset.cwiseAbs().maxCoeff() : offset.stableNorm();
    result.normal = box.axes * (result.beyond == 1 ? Vec3(result.side[0], result.side[1], result.side[2])
                                                   : Vec3(offset.stableNormalized()));
    result.point = box.to_world(clamped);
    return result;
  }
  // inside, or on the surface: out through the nearest face
  int axis = 0;
  double depth = box.half[0] - std::abs(local[0]);
  for (int k = 1; k < 3; ++k)
    if (box.half[k] - std::abs(local[k]) < depth) {
      depth = box.half[k] - std::abs(local[k]);
      axis = k;
    }
  result.side[axis] = local[axis] < 0.0 ? -1 : 1;
  result.beyond = 1;
  result.distance = -depth;
  Vec3 point = local;
  point[axis] = result.side[axis] * box.half[axis];
  result.point = box.to_world(point);
  result.normal = box.axes.col(axis) * result.side[axis];
  return result;
}

}  // namespace impinge
