#include "engine/detection/pairs/way_apart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"

namespace impinge {
namespace {

/// The corners of what of a triangle is in the box [SutherlandHodgman74].
std::vector<Vec3> part_in_box(const TriangleCorners& c, const Aabb& box) {
  std::vector<Vec3> polygon(c.begin(), c.end()), next;
  for (int side = 0; side < 6 && !polygon.empty(); ++side) {
    const int k = side / 2;
    const auto beyond = [&](const Vec3& x) { return side % 2 == 0 ? box.min[k] - x[k] : x[k] - box.max[k]; };
    next.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double dp = beyond(p), dq = beyond(q);
      if (dp <= 0.0) next.push_back(p);
      if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) next.push_back(p + dp / (dp - dq) * (q - p));
    }
    polygon.swap(next);
  }
  return polygon;
}

}  // namespace

std::optional<Candidate> way_apart(const SurfaceView& mesh, const PlacedConvex& solid, const Aabb& bounds,
                                   const std::vector<int>& triangles, double touch) {
  std::vector<Vec3> ways;
  std::vector<std::pair<Vec3, int>> places;  // and the triangle of each
  for (const int t : triangles) {
    const TriangleCorners c = mesh.corners(t);
    const Vec3 face = mesh.face_normal(t);
    if (face.isZero(0.0)) continue;
    const ConvexTriangle flat({Vec3::Zero(), c[1] - c[0], c[2] - c[0]});
    const ConvexGap gap = convex_gap(solid, {&flat, {Mat3::Identity(), c[0]}}, 0.0);
    if (!gap.is_within_reach || gap.gap > -touch) continue;
    ways.push_back(face);
    if (gap.normal.dot(face) > 0.0) ways.push_back(gap.normal);
    for (const Vec3& x : part_in_box(c, bounds)) places.emplace_back(x, t);
  }
  if (places.empty()) return std::nullopt;
  Candidate best;
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& n : ways) {
    const auto highest = std::max_element(
        places.begin(), places.end(), [&](const auto& l, const auto& r) { return l.first.dot(n) < r.first.dot(n); });
    const Vec3 local = solid.pose.rotation.transpose() * -n;
    const Vec3 lowest = solid.pose.apply(solid.set->support(local) + solid.set->rounding() * local);
    const double depth = n.dot(highest->first - lowest);
    if (!(depth < least)) continue;
    least = depth;
    best.normal = n;
    best.point_second = highest->first;
    best.point_first = highest->first - depth * n;
    best.kind_second = Feature::face;
    best.index_second = best.triangle_second = highest->second;
  }
  return least > touch ? std::optional(best) : std::nullopt;
}

}  // namespace impinge
