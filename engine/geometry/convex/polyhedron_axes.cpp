#include "engine/geometry/convex/polyhedron_axes.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/convex/orientation.hpp"

namespace impinge {
namespace {

using Face = ConvexPolyhedron::Face;
using Edge = ConvexPolyhedron::Edge;

constexpr double kNearby = 1.0 - 4e-5;  // cosine of half a degree

/// The faces and edges of both in world axes, a's moved by the offset between them.
class Axes {
 public:
  explicit Axes(const MinkowskiDifference& d) : d_(d), a_(*d.polyhedron_a()), b_(*d.polyhedron_b()) {}

  Vec3 normal_a(int f) const { return d_.a().pose.rotation * a_.faces()[f].normal; }
  Vec3 normal_b(int f) const { return d_.b().pose.rotation * b_.faces()[f].normal; }
  Vec3 along_a(const Edge& e) const {
    return d_.a().pose.rotation * (a_.vertices()[e.vertex1] - a_.vertices()[e.vertex0]);
  }
  Vec3 along_b(const Edge& e) const {
    return d_.b().pose.rotation * (b_.vertices()[e.vertex1] - b_.vertices()[e.vertex0]);
  }

  void take(const Vec3& direction, double tie) {
    const double separation = d_.separation(direction);
    if (separation > best.separation + tie) best = {direction, separation};
  }
  /// The edges' common normal that points out of b's edge.
  void take_edges(const Vec3& along_a, const Vec3& along_b, const Vec3& out_of_b, double tie) {
    const Vec3 cross = accurate_cross(along_a, along_b);
    const double length = cross.norm();
    if (!(length > 1e-14 * along_a.norm() * along_b.norm())) return;
    const Vec3 direction = cross / length;
    take(direction.dot(out_of_b) < 0.0 ? Vec3(-direction) : direction, tie);
  }

  SeparatingAxis best;

 private:
  const MinkowskiDifference& d_;
  const ConvexPolyhedron &a_, &b_;
};

}  // namespace

SeparatingAxis best_axis(const MinkowskiDifference& d, double tie) {
  const ConvexPolyhedron &a = *d.polyhedron_a(), &b = *d.polyhedron_b();
  Axes axes(d);
  std::vector<Vec3> normals_a, normals_b;
  for (std::size_t f = 0; f < a.faces().size(); ++f) {
    normals_a.push_back(axes.normal_a(static_cast<int>(f)));
    axes.take(-normals_a.back(), tie);
  }
  for (std::size_t f = 0; f < b.faces().size(); ++f) {
    normals_b.push_back(axes.normal_b(static_cast<int>(f)));
    axes.take(normals_b.back(), tie);
  }
  for (const Edge& ea : a.edges()) {
    // the arc from a0 to a1 against that from -b0 to -b1: each lies in the plane at right angles to its edge, whose
    // direction is known better than the product of two normals that are nearly opposite
    const Vec3 &a0 = normals_a[ea.face0], &a1 = normals_a[ea.face1], along_a = axes.along_a(ea);
    for (const Edge& eb : b.edges()) {
      const Vec3 b0 = -normals_b[eb.face0], b1 = -normals_b[eb.face1];
      const double sees0 = b0.dot(along_a), sees1 = b1.dot(along_a);
      if (!(sees0 * sees1 < 0.0)) continue;
      const Vec3 along_b = axes.along_b(eb);
      const double seen0 = a0.dot(along_b), seen1 = a1.dot(along_b);
      if (!(seen0 * seen1 < 0.0 && sees0 * seen1 > 0.0)) continue;
      axes.take_edges(along_a, along_b, -(b0 + b1), tie);
    }
  }
  return axes.best;
}

SeparatingAxis nearby_axis(const MinkowskiDifference& d, std::span<const MinkowskiPoint> corners,
                           const Vec3& direction) {
  const ConvexPolyhedron &a = *d.polyhedron_a(), &b = *d.polyhedron_b();
  Axes axes(d);
  const auto unique = [&](auto&& number, auto&& rows) {
    std::vector<int> all;
    for (const MinkowskiPoint& p : corners)
      if (number(p) >= 0) {
        const std::span<const int> r = rows(number(p));
        all.insert(all.end(), r.begin(), r.end());
      }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  };
  const auto of_a = [](const MinkowskiPoint& p) { return p.vertex_a; };
  const auto of_b = [](const MinkowskiPoint& p) { return p.vertex_b; };
  for (int f : unique(of_a, [&](int v) { return a.faces_round(v); }))
    if (const Vec3 n = -axes.normal_a(f); n.dot(direction) > kNearby) axes.take(n, 0.0);
  for (int f : unique(of_b, [&](int v) { return b.faces_round(v); }))
    if (const Vec3 n = axes.normal_b(f); n.dot(direction) > kNearby) axes.take(n, 0.0);
  const std::vector<int> edges_b = unique(of_b, [&](int v) { return b.edges_round(v); });
  for (int ea : unique(of_a, [&](int v) { return a.edges_round(v); })) {
    const Vec3 along = axes.along_a(a.edges()[ea]);
    for (int eb : edges_b) {
      const Vec3 other = axes.along_b(b.edges()[eb]), cross = along.cross(other);
      const double length_sq = cross.squaredNorm(), on = cross.dot(direction);
      // edges that are all but parallel have no direction worth a look: here the faces beside them do
      if (length_sq > 1e-16 * along.squaredNorm() * other.squaredNorm() && on * on > kNearby * kNearby * length_sq)
        axes.take_edges(along, other, direction, 0.0);
    }
  }
  return axes.best;
}

}  // namespace impinge
