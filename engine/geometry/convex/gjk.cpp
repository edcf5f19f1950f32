#include "engine/geometry/convex/gjk.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

constexpr int kMostSteps = 256;
constexpr double kTouching = 1e-13;  // of the size

/// The nearest point of a simplex to the origin; the simplex loses the corners that have no part in it.
class Simplex {
 public:
  explicit Simplex(GjkResult& r) : r_(r) {}

  /// False if it holds the origin.
  bool reduce() {
    switch (r_.count) {
      case 1:
        r_.nearest = r_.point[0].w;
        return true;
      case 2:
        return reduce_segment();
      case 3:
        return reduce_triangle({0, 1, 2});
      default:
        return reduce_tetrahedron();
    }
  }

 private:
  bool reduce_segment() {
    const PointSegment s = closest_on_segment(Vec3::Zero(), r_.point[0].w, r_.point[1].w);
    r_.nearest = s.point;
    if (s.t <= 0.0) keep({0});
    if (s.t >= 1.0) keep({1});
    return true;
  }

  bool reduce_triangle(const std::array<int, 3>& corner) {
    const PointTriangle p = on_triangle(corner);
    r_.nearest = p.point;
    const int k = feature_number(p.feature);
    if (is_corner(p.feature))
      keep({corner[k]});
    else if (is_edge(p.feature))
      keep({corner[k], corner[(k + 1) % 3]});
    else
      keep({corner[0], corner[1], corner[2]});
    return true;
  }

  bool reduce_tetrahedron() {
    static constexpr int kFace[4][4] = {{1, 2, 3, 0}, {0, 2, 3, 1}, {0, 1, 3, 2}, {0, 1, 2, 3}};
    bool inside = true;
    int best = -1;
    double nearest_sq = 0.0;
    for (int f = 0; f < 4; ++f) {
      const Vec3 &a = r_.point[kFace[f][0]].w, &b = r_.point[kFace[f][1]].w, &c = r_.point[kFace[f][2]].w,
                 &d = r_.point[kFace[f][3]].w;
      const Vec3 n = (b - a).cross(c - a);
      const double of_origin = -n.dot(a), of_corner = n.dot(d - a);
      // a flat tetrahedron holds nothing
      if (!(of_origin * of_corner > 0.0)) inside = false;
      const PointTriangle p = on_triangle({kFace[f][0], kFace[f][1], kFace[f][2]});
      if (best < 0 || p.squared_distance < nearest_sq) best = f, nearest_sq = p.squared_distance;
    }
    if (inside) return false;
    return reduce_triangle({kFace[best][0], kFace[best][1], kFace[best][2]});
  }

  PointTriangle on_triangle(const std::array<int, 3>& corner) const {
    return closest_on_triangle(Vec3::Zero(), {r_.point[corner[0]].w, r_.point[corner[1]].w, r_.point[corner[2]].w});
  }

  void keep(std::initializer_list<int> corners) {
    std::array<MinkowskiPoint, 4> kept;
    int count = 0;
    for (int c : corners) kept[count++] = r_.point[c];
    r_.point = kept;
    r_.count = count;
  }

  GjkResult& r_;
};

}  // namespace

GjkResult gjk(const MinkowskiDifference& difference, double reach) {
  GjkResult r;
  Vec3 start = -difference.offset();
  if (start.isZero(0.0)) start = Vec3::UnitX();
  r.point[0] = difference.support(start);
  r.count = 1;
  r.nearest = r.point[0].w;
  r.size = r.nearest.norm();
  GjkResult best = r;
  double best_sq = r.nearest.squaredNorm();
  // corners are met again when there is nothing nearer; on a curved surface each point is a new one
  const double slack = difference.is_polyhedral() ? 1e-15 : 1e-13;
  for (int step = 0; step < kMostSteps; ++step) {
    const double length = std::sqrt(best_sq);
    if (length <= kTouching * r.size) return r;
    const MinkowskiPoint p = difference.support(-r.nearest);
    r.size = std::max(r.size, p.w.norm());
    const double lower = r.nearest.dot(p.w) / length;  // nothing is nearer than this
    bool done = length - lower <= slack * r.size || lower > reach;
    for (int i = 0; i < r.count && !done; ++i) done = r.point[i].a == p.a && r.point[i].b == p.b;
    if (done) break;
    r.point[r.count++] = p;
    if (!Simplex(r).reduce()) return r;
    const double length_sq = r.nearest.squaredNorm();
    if (!(length_sq < best_sq)) break;  // rounding: no nearer than before
    best_sq = length_sq;
    best = r;
  }
  const double size = r.size;
  r = best;
  r.size = size;
  r.distance = std::sqrt(best_sq);
  r.apart = r.distance > kTouching * size;
  return r;
}

}  // namespace impinge
