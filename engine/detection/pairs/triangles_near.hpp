// Which triangles of a mesh are near something: through the tree of a rigid mesh, which is made once and asked in the
// mesh's own frame, or that of a deforming one where its boxes have been fitted. A list is what a look at every triangle
// would give, to the bit.
#pragma once

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

}  // namespace impinge
