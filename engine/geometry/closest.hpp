// Closest points of segments and triangles, with the feature on which they lie.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/core/types.hpp"

namespace impinge {

/// Parameter in [0, 1] of the point of segment p0 p1 nearest to x; 0 for a segment without length.
inline double closest_parameter(const Vec3& x, const Vec3& p0, const Vec3& p1) {
  const Vec3 d = p1 - p0;
  const double length_sq = d.squaredNorm();
  return length_sq > 0.0 ? std::clamp(d.dot(x - p0) / length_sq, 0.0, 1.0) : 0.0;
}

struct ClosestOnTriangle {
  Vec3 point = Vec3::Zero();
  int kind = 2;   ///< 0 corner, 1 edge, 2 face
  int index = 0;  ///< of the corner, or of the edge from corner k to k+1
  double distance_sq = 0.0;
};

/// Point of the closed triangle (a, b, c) nearest to x. A triangle without area is the union of its edges.
inline ClosestOnTriangle closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* corner[3] = {&a, &b, &c};
  const Vec3 normal = (b - a).cross(c - a);
  const double normal_sq = normal.squaredNorm();
  ClosestOnTriangle best;
  best.distance_sq = -1.0;
  for (int k = 0; k < 3; ++k) {
    const Vec3& p = *corner[k];
    const Vec3& q = *corner[(k + 1) % 3];
    // only an edge whose outer side x is on can hold the nearest point
    if (normal_sq > 0.0 && (x - p).dot((q - p).cross(normal)) < 0.0) continue;
    const double t = closest_parameter(x, p, q);
    const Vec3 point = t <= 0.0 ? p : t >= 1.0 ? q : Vec3(p + t * (q - p));
    const double distance_sq = (x - point).squaredNorm();
    if (best.distance_sq >= 0.0 && distance_sq >= best.distance_sq) continue;
    best = {point, t <= 0.0 || t >= 1.0 ? 0 : 1, t >= 1.0 ? (k + 1) % 3 : k, distance_sq};
  }
  if (best.distance_sq >= 0.0) return best;
  const double height = normal.dot(x - a);
  return {x - normal * (height / normal_sq), 2, 0, height * height / normal_sq};
}

struct ClosestOnSegments {
  double s = 0.0, t = 0.0;  ///< parameters in [0, 1] on the first and second segment
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();
  bool parallel = false;    ///< the directions are too close for an inner solution to mean anything
};

/// Closest points of the segments p0 p1 and q0 q1. The distance is convex in (s, t): an inner stationary point is the
/// minimum, else it lies where one of the four ends projects onto the other segment.
inline ClosestOnSegments closest_on_segments(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const Vec3 cross = u.cross(v);
  const double det = cross.squaredNorm();  // = uu vv - uv², without its cancellation
  ClosestOnSegments result;
  result.parallel = !(det > 1e-14 * uu * vv);
  if (!result.parallel) {
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / det;
    const double t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) {
      result.s = s;
      result.t = t;
      result.p = p0 + s * u;
      result.q = q0 + t * v;
      return result;
    }
  }
  double best = -1.0;
  const auto consider = [&](double s, double t) {
    const Vec3 p = s <= 0.0 ? p0 : s >= 1.0 ? p1 : Vec3(p0 + s * u);
    const Vec3 q = t <= 0.0 ? q0 : t >= 1.0 ? q1 : Vec3(q0 + t * v);
    const double distance_sq = (p - q).squaredNorm();
    if (best >= 0.0 && distance_sq >= best) return;
    best = distance_sq;
    result.s = s;
    result.t = t;
    result.p = p;
    result.q = q;
  };
  consider(0.0, closest_parameter(p0, q0, q1));
  consider(1.0, closest_parameter(p1, q0, q1));
  consider(closest_parameter(q0, p0, p1), 0.0);
  consider(closest_parameter(q1, p0, p1), 1.0);
  return result;
}

}  // namespace impinge
