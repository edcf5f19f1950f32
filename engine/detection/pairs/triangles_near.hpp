// Which triangles of a mesh are near something: through the tree of a rigid mesh, which is made once and asked in the
// mesh's own frame, or that of a deforming one where its boxes have been fitted. A list is what a look at every triangle
// would give, to the bit.
#pragma once

#include <functional>
#include <optional>

#include "engine/detection/contacts/surface_view.hpp"

namespace impinge {

/// Bounds of triangle t of the mesh.
inline Aabb triangle_bounds(const SurfaceView& mesh, int t) {
  const Triangle& c = mesh.triangle(t);
  return bounds_of(mesh.vertex(c[0]), mesh.vertex(c[1]), mesh.vertex(c[2]));
}

/// Those whose bounds overlap the box, ascending.
std::vector<int> triangles_near(const Collider& mesh, const Aabb& box);

/// At least those whose bounds are within `distance` of x, metres, and, if it is asked for, those whose distance to x is
/// the least of all; ascending.
std::vector<int> triangles_round(const Collider& mesh, const Vec3& x, double distance, bool and_nearest);

/// Of those that triangles_round finds at least the ones that hold a place nearer to x than all the surface round it: from
/// x a ball meets no other, and on a smooth rigid surface they are few, however fine it is.
std::vector<int> triangles_seen_from(const Collider& mesh, const Vec3& x, double distance, bool and_nearest);

/// The same of triangles near a segment, from outside: at least those whose nearest place is within `distance`.
std::vector<int> triangles_seen_from(const Collider& mesh, const Vec3& p, const Vec3& q, double distance);

/// A convex solid in the world, in a frame of its own.
struct SolidFrame {
  Pose pose;
  const ConvexSet* set = nullptr;
  std::function<double(const Vec3&)> distance;  ///< of a point, not more than it is; any number <= 0 in it
  /// A point of the solid farthest along a direction of any length but zero.
  Vec3 support(const Vec3& d) const {
    const double rounding = set->rounding();
    return rounding > 0.0 ? Vec3(set->support(d) + rounding * d.normalized()) : set->support(d);
  }
  /// How far it goes along a direction from the frame's origin, times the direction's length.
  double height(const Vec3& d) const { return d.dot(support(d)); }
  /// Round it, along its own axes.
  Aabb box() const {
    Aabb all;
    for (int k = 0; k < 3; ++k) all.include(support(Vec3::Unit(k))), all.include(support(-Vec3::Unit(k)));
    return all;
  }
};

/// Whether the mesh has discs and cones of normals to walk down: it is rigid, and not so small that looking at each
/// triangle is as quick.
bool has_cones(const Collider& mesh);

/// `distance`, metres, and what coordinates in and round the box lose on the way into the frame of the mesh.
double widened(const Collider& mesh, const Aabb& box, double distance);

/// Of those whose bounds overlap the box at least the ones within `reach` of the solid; ascending. Where there may be more
/// than `most`, nothing.
std::optional<std::vector<int>> triangles_within(const Collider& mesh, const Aabb& box, const SolidFrame& solid,
                                                 double reach, std::size_t most);
std::vector<int> triangles_within(const Collider& mesh, const Aabb& box, const SolidFrame& solid, double reach);

}  // namespace impinge
