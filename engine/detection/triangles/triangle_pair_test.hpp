// What every narrow phase between meshes shares: the exact test of one triangle pair, and boxes that miss none of them.
#pragma once

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {

inline TriangleCorners corners_of(const Collider& collider, int triangle) {
  const Triangle& t = collider.mesh().mesh.triangles[triangle];
  return {collider.vertices[t[0]], collider.vertices[t[1]], collider.vertices[t[2]]};
}

/// Box of a triangle that overlaps the like box of every triangle no farther than `margin` (or touching within
/// tolerance).
inline Aabb search_box(const TriangleCorners& c, double margin) {
  return bounds_of(c[0], c[1], c[2]).inflated(0.5 * margin * (1.0 + 1e-9) + 2.0 * touch_distance(c));
}

enum class PairState { apart, close, intersecting };

/// The exact test: intersecting, close (distance <= margin) or apart.
inline PairState test_triangles(const TriangleCorners& a, const TriangleCorners& b, double margin) {
  if (triangles_intersect(a, b)) return PairState::intersecting;
  return margin > 0.0 && features_within(a, b, margin) ? PairState::close : PairState::apart;
}

inline bool share_a_vertex(const Triangle& a, const Triangle& b) {
  for (int i : a)
    if (i == b[0] || i == b[1] || i == b[2]) return true;
  return false;
}

}  // namespace impinge
