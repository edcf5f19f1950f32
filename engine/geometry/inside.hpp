// Whether a point lies inside a closed surface, and how deep: slow, exact in what it decides, and used by judges, and
// where nothing quicker can tell.
#pragma once

#include <span>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Of a triangle seen from the origin, signed; within 2π of 0. [VanOosterom83]
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// Winding number of a closed surface round x: the sum of the triangles' solid angles over 4π. 1 inside,
/// 0 outside, 1/2 on the surface; a surface that intersects itself has larger numbers where it overlaps.
double winding_number(const Vec3& x, std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// Distance from x to the nearest triangle, metres.
double distance_to_surface(const Vec3& x, std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace impinge
