// Triangle surfaces of exact shapes, as fine as a deformable body of that shape wants them.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// An icosahedron whose edges are halved k times, vertices on the sphere: 20·4^k triangles, closed, outward.
TriangleMesh sphere_surface(double radius, int k);

/// A box about the origin, each side cut into cells[axis] pieces, two triangles a cell; vertices shared, closed,
/// outward.
TriangleMesh box_surface(const Vec3& half, const Eigen::Vector3i& cells);

/// A capsule about the origin along y, cap centres at y = ±half_length: `around` >= 3 vertices a ring, rings about as
/// far apart as their vertices; closed, outward.
TriangleMesh capsule_surface(double radius, double half_length, int around);

}  // namespace impinge
