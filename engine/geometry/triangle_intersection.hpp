// Whether two triangles share a point: six edge-triangle tests [Moller97], with the cases the seed leaves open
// (touching, coplanar, degenerate) decided by distance. [Haapaoja16 §3.2.3]
//
// Tolerance. Triangles are closed, and count as touching within kTouchTolerance times the largest coordinate of either:
// some tens of roundings, what a pose leaves of two surfaces that touch exactly. So triangles that share a corner, an
// edge or a face are never missed at any pose; 1e5 m from the origin the tolerance is about 1e-9 m.
//
// How it is decided. Each edge-triangle test has a band round its borders, far wider than rounding. Outside all bands
// the answer is certain. Inside one the pair is decided by the distance of corners, edges and faces and by the plain
// test in wide numbers, on a sorted copy of the triangles: the answer does not depend on the order of the triangles or
// of their corners, bit for bit. There is no division in it: no input of finite numbers gives NaN.
#pragma once

#include <optional>

#include "engine/geometry/distance.hpp"

namespace impinge {

inline constexpr double kTouchTolerance = 64.0 * 0x1.0p-52;

bool triangles_intersect(const TriangleCorners& a, const TriangleCorners& b);

/// Distance within which these coordinates count as touching, metres.
double touch_distance(const TriangleCorners& a);

struct RayHit {
  double t = 0.0;           ///< the point is origin + t * direction
  double u = 0.0, v = 0.0;  ///< it is (1-u-v) c0 + u c1 + v c2
};
/// Where the line origin + t·direction meets the triangle's plane, if that is inside the closed triangle widened by
/// `slack` in barycentric coordinates; nothing for a line parallel to the plane or a triangle of no area. t may be
/// negative.
std::optional<RayHit> intersect_line(const Vec3& origin, const Vec3& direction, const TriangleCorners& triangle,
                                     double slack = 0.0);

}  // namespace impinge
