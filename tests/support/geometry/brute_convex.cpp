#include "tests/support/geometry/brute_convex.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace impinge::test {
namespace {

using Real = long double;
using Long3 = Eigen::Matrix<Real, 3, 1>;

struct Solid {
  std::vector<Long3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::pair<int, int>> edges;

  explicit Solid(const TriangleMesh& mesh) : triangles(mesh.triangles) {
    for (const Vec3& v : mesh.vertices) vertices.push_back(v.cast<Real>());
    std::set<std::pair<int, int>> all;
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) all.insert(std::minmax(t[k], t[(k + 1) % 3]));
    edges.assign(all.begin(), all.end());
  }
  std::array<Real, 2> range(const Long3& n) const {
    std::array<Real, 2> r{1e300L, -1e300L};
    for (const Long3& v : vertices) r[0] = std::min(r[0], n.dot(v)), r[1] = std::max(r[1], n.dot(v));
    return r;
  }
};

Real to_segment(const Long3& x, const Long3& p, const Long3& q) {
  const Long3 d = q - p;
  const Real length2 = d.squaredNorm();
  const Real t = length2 > 0 ? std::clamp<Real>(d.dot(x - p) / length2, 0, 1) : 0;
  return (x - p - t * d).norm();
}

/// The height over the triangle where the foot lies in it, else infinite: its edges are looked at by themselves.
Real to_triangle(const Long3& x, const Long3& a, const Long3& b, const Long3& c) {
  const Long3 n = (b - a).cross(c - a);
  const Real area = n.norm();
  if (!(area > 0)) return 1e300L;
  if ((b - a).cross(x - a).dot(n) < 0 || (c - b).cross(x - b).dot(n) < 0 || (a - c).cross(x - c).dot(n) < 0)
    return 1e300L;
  return std::abs((x - a).dot(n)) / area;
}

/// The distance of the lines where both feet lie in the segments, and of the ends.
Real between_segments(const Long3& p, const Long3& q, const Long3& r, const Long3& s) {
  Real best = std::min({to_segment(p, r, s), to_segment(q, r, s), to_segment(r, p, q), to_segment(s, p, q)});
  const Long3 u = q - p, v = s - r, n = u.cross(v);
  const Real n2 = n.squaredNorm();
  if (n2 > 0) {
    const Real a = (r - p).cross(v).dot(n) / n2, b = (r - p).cross(u).dot(n) / n2;
    if (a >= 0 && a <= 1 && b >= 0 && b <= 1) best = std::min(best, (p + a * u - r - b * v).norm());
  }
  return best;
}

}  // namespace

BruteGap brute_convex_gap(const TriangleMesh& mesh_a, const TriangleMesh& mesh_b) {
  const Solid a(mesh_a), b(mesh_b);
  Real depth = 1e300L;
  const auto try_axis = [&](const Long3& axis) {
    const Real length = axis.norm();
    if (!(length > 0)) return;
    const Long3 n = axis / length;
    const auto ra = a.range(n), rb = b.range(n);
    depth = std::min({depth, ra[1] - rb[0], rb[1] - ra[0]});
  };
  for (const Solid* s : {&a, &b})
    for (const Triangle& t : s->triangles)
      try_axis((s->vertices[t[1]] - s->vertices[t[0]]).cross(s->vertices[t[2]] - s->vertices[t[0]]));
  for (const auto& [p, q] : a.edges)
    for (const auto& [r, s] : b.edges) {
      const Long3 u = a.vertices[q] - a.vertices[p], v = b.vertices[s] - b.vertices[r], n = u.cross(v);
      // parallel in the precision there is: its direction would be noise, and a noise axis is still no better than the
      // least overlap
      if (n.norm() > 1e-17L * u.norm() * v.norm()) try_axis(n);
    }
  if (depth >= 0) return {-static_cast<double>(depth), true};
  Real distance = 1e300L;
  for (const auto& [first, second] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Long3& x : first->vertices)
      for (const Triangle& t : second->triangles)
        distance =
            std::min(distance, to_triangle(x, second->vertices[t[0]], second->vertices[t[1]], second->vertices[t[2]]));
  for (const auto& [p, q] : a.edges)
    for (const auto& [r, s] : b.edges)
      distance = std::min(distance, between_segments(a.vertices[p], a.vertices[q], b.vertices[r], b.vertices[s]));
  return {static_cast<double>(distance), false};
}

}  // namespace impinge::test
