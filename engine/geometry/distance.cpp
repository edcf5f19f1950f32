#include "engine/geometry/distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

bool is_before(const Vec3& l, const Vec3& r) {
  return std::lexicographical_compare(l.data(), l.data() + 3, r.data(), r.data() + 3);
}

void keep_closer(SegmentSegment& best, double s, double t, const Vec3& point0, const Vec3& point1) {
  const double squared = (point0 - point1).squaredNorm();
  if (squared < best.squared_distance) best = {s, t, point0, point1, squared, false};
}

SegmentSegment closest_in_order(const Vec3& p0, const Vec3& q0, const Vec3& p1, const Vec3& q1) {
  const Vec3 d0 = q0 - p0, d1 = q1 - p1, r = p1 - p0;
  // the lines' common normal by a cross product: a*c - b*b would cancel for nearly parallel segments
  const Vec3 normal = d0.cross(d1);
  const double squared_normal = normal.squaredNorm(), a = d0.squaredNorm(), c = d1.squaredNorm();
  if (squared_normal > 1e-24 * a * c) {
    const double s = r.cross(d1).dot(normal) / squared_normal, t = r.cross(d0).dot(normal) / squared_normal;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) {
      const Vec3 point0 = p0 + s * d0, point1 = p1 + t * d1;
      SegmentSegment best{s, t, point0, point1, (point0 - point1).squaredNorm(), true};
      if (squared_normal > 1e-8 * a * c) return best;
      // nearly parallel: s and t carry large errors, so an end point may still be closer
      for (const auto& [x, u] : {std::pair{p0, 0.0}, std::pair{q0, 1.0}}) {
        const PointSegment e = closest_on_segment(x, p1, q1);
        keep_closer(best, u, e.t, x, e.point);
      }
      for (const auto& [x, u] : {std::pair{p1, 0.0}, std::pair{q1, 1.0}}) {
        const PointSegment e = closest_on_segment(x, p0, q0);
        keep_closer(best, e.t, u, e.point, x);
      }
      return best;
    }
  }
  SegmentSegment best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  PointSegment e = closest_on_segment(p0, p1, q1);
  keep_closer(best, 0.0, e.t, p0, e.point);
  e = closest_on_segment(q0, p1, q1);
  keep_closer(best, 1.0, e.t, q0, e.point);
  e = closest_on_segment(p1, p0, q0);
  keep_closer(best, e.t, 0.0, e.point, p1);
  e = closest_on_segment(q1, p0, q0);
  keep_closer(best, e.t, 1.0, e.point, q1);
  return best;
}

}  // namespace

PointSegment closest_on_segment(const Vec3& x, const Vec3& p, const Vec3& q) {
  const Vec3 d = q - p;
  const double along = d.dot(x - p), length2 = d.squaredNorm();
  // compared before dividing: a segment of no length is its first end point
  if (!(along > 0.0)) return {0.0, p, (x - p).squaredNorm()};
  if (along >= length2) return {1.0, q, (x - q).squaredNorm()};
  const double t = along / length2;
  const Vec3 point = p + t * d;
  return {t, point, (x - point).squaredNorm()};
}

PointTriangle closest_on_triangle(const Vec3& x, const TriangleCorners& c) {
  const Vec3 e0 = c[1] - c[0], e1 = c[2] - c[1], e2 = c[0] - c[2];
  const Vec3 normal = e0.cross(-e2);
  const double area2 = normal.squaredNorm();
  const double longest = std::max({e0.squaredNorm(), e1.squaredNorm(), e2.squaredNorm()});
  // flatter than this the direction of the normal is noise, and the edges are the triangle
  const bool is_flat = !(area2 > 1e-28 * longest * longest);
  const Vec3 r0 = x - c[0];
  double side[3] = {-1.0, -1.0, -1.0};
  PointTriangle thin;
  thin.squared_distance = std::numeric_limits<double>::infinity();
  if (!is_flat) {
    side[0] = e0.cross(r0).dot(normal);
    side[1] = e1.cross(x - c[1]).dot(normal);
    side[2] = e2.cross(x - c[2]).dot(normal);
    if (side[0] > 0.0 && side[1] > 0.0 && side[2] > 0.0) {
      if (area2 > 1e-8 * longest * longest) {
        const double height = normal.dot(r0);
        return {x - (height / area2) * normal, TriangleFeature::face, height * height / area2};
      }
      // thin: the normal leans by its rounding, so the foot is taken from its weights, inside the triangle for certain,
      // and an edge may still be closer
      const double sum = side[0] + side[1] + side[2];
      const Vec3 foot = (side[1] / sum) * c[0] + (side[2] / sum) * c[1] + (side[0] / sum) * c[2];
      thin = {foot, TriangleFeature::face, (x - foot).squaredNorm()};
      side[0] = side[1] = side[2] = -1.0;
    }
  }
  PointTriangle best = thin;
  for (int k = 0; k < 3; ++k) {
    if (side[k] > 0.0) continue;  // the closest point lies on an edge that has x on its outer side
    const PointSegment e = closest_on_segment(x, c[k], c[(k + 1) % 3]);
    if (e.squared_distance >= best.squared_distance) continue;
    const int number = e.t <= 0.0 ? k : e.t >= 1.0 ? (k + 1) % 3 : 3 + k;
    best = {e.point, static_cast<TriangleFeature>(number), e.squared_distance};
  }
  return best;
}

SegmentSegment closest_between_segments(const Vec3& p0, const Vec3& q0, const Vec3& p1, const Vec3& q1) {
  const bool is_swapped = is_before(p1, p0) || (p1 == p0 && is_before(q1, q0));
  if (!is_swapped) return closest_in_order(p0, q0, p1, q1);
  SegmentSegment found = closest_in_order(p1, q1, p0, q0);
  std::swap(found.s, found.t);
  std::swap(found.point0, found.point1);
  return found;
}

TriangleTriangle closest_features(const TriangleCorners& a, const TriangleCorners& b) {
  TriangleTriangle best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const auto keep = [&](const Vec3& point0, const Vec3& point1, double squared) {
    if (squared < best.squared_distance) best = {point0, point1, squared};
  };
  for (int k = 0; k < 3; ++k) {
    const PointTriangle on_b = closest_on_triangle(a[k], b), on_a = closest_on_triangle(b[k], a);
    keep(a[k], on_b.point, on_b.squared_distance);
    keep(on_a.point, b[k], on_a.squared_distance);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const SegmentSegment e = closest_between_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      keep(e.point0, e.point1, e.squared_distance);
    }
  return best;
}

namespace {

/// Whether planes at right angles to n with more than the limit between them separate the two, by more than rounding.
bool are_apart_along(const Vec3& n, const TriangleCorners& a, const TriangleCorners& b, double limit) {
  double low_a = 0.0, high_a = 0.0, low_b = INFINITY, high_b = -INFINITY;  // from a[0]
  for (int k = 0; k < 3; ++k) {
    const double x = n.dot(a[k] - a[0]), y = n.dot(b[k] - a[0]);
    low_a = std::min(low_a, x), high_a = std::max(high_a, x);
    low_b = std::min(low_b, y), high_b = std::max(high_b, y);
  }
  const double gap = std::max(low_a - high_b, low_b - high_a);
  return gap > 0.0 && gap * gap > limit * limit * n.squaredNorm();
}

}  // namespace

bool features_within(const TriangleCorners& a, const TriangleCorners& b, double limit) {
  // most pairs whose boxes meet are told apart by a plane
  Vec3 largest = Vec3::Zero();
  for (int k = 0; k < 3; ++k) largest = largest.cwiseMax(a[k].cwiseAbs()).cwiseMax(b[k].cwiseAbs());
  const double certain = limit * (1.0 + 1e-6) + 1e-13 * largest.maxCoeff();
  if (are_apart_along((a[1] - a[0]).cross(a[2] - a[0]), a, b, certain) ||
      are_apart_along((b[1] - b[0]).cross(b[2] - b[0]), a, b, certain) ||
      are_apart_along(a[0] + a[1] + a[2] - b[0] - b[1] - b[2], a, b, certain))
    return false;
  const double limit2 = limit * limit;
  for (int k = 0; k < 3; ++k) {
    if (closest_on_triangle(a[k], b).squared_distance <= limit2) return true;
    if (closest_on_triangle(b[k], a).squared_distance <= limit2) return true;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (closest_between_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]).squared_distance <= limit2) return true;
  return false;
}

double triangle_distance(const TriangleCorners& a, const TriangleCorners& b) {
  return triangles_intersect(a, b) ? 0.0 : std::sqrt(closest_features(a, b).squared_distance);
}

Vec3 nearest_weights(const Vec3& x, const TriangleCorners& triangle) {
  const Vec3 a = triangle[0], e0 = triangle[1] - a, e1 = triangle[2] - a,
             d = closest_on_triangle(x, triangle).point - a;
  const double d00 = e0.dot(e0), d01 = e0.dot(e1), d11 = e1.dot(e1), d20 = d.dot(e0), d21 = d.dot(e1);
  const double denominator = d00 * d11 - d01 * d01;
  if (!(denominator > 0.0)) return Vec3::Unit(0);
  const double v = (d11 * d20 - d01 * d21) / denominator, w = (d00 * d21 - d01 * d20) / denominator;
  return {1.0 - v - w, v, w};
}

}  // namespace impinge
