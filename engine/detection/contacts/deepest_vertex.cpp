#include "engine/detection/contacts/deepest_vertex.hpp"

#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/surface_view.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {
namespace {

/// A surface that is asked for the point nearest to others: a rigid one in its own frame, one that deforms where it
/// stands.
class Surface {
 public:
  Surface(const Collider& collider, BodyIndex body) : collider_(collider), view_(collider, body) {
    if (view_.is_deforming())
      surface().tree().fit(triangle_boxes(surface().mesh.triangles, collider.vertices), fitted_);
  }

  /// The point of the surface nearest to x if x lies inside.
  std::optional<NearestTriangle> if_inside(const Vec3& x) const {
    if (!overlap(collider_.bounds, Aabb{x, x})) return std::nullopt;
    NearestTriangle found = nearest(x);
    const Vec3 normal = view_.normal(view_.feature(found.triangle, found.at.feature));
    return (x - found.at.point).dot(normal) < 0.0 ? std::optional(found) : std::nullopt;
  }

  bool winds_round(const Vec3& x) const { return view_.winds_round(x); }

 private:
  const SurfaceMesh& surface() const { return collider_.mesh(); }

  NearestTriangle nearest(const Vec3& x) const {
    const TriangleMesh& mesh = surface().mesh;
    if (view_.is_deforming()) return nearest_triangle(surface().tree(), mesh.triangles, collider_.vertices, x, fitted_);
    NearestTriangle found =
        nearest_triangle(surface().tree(), mesh.triangles, mesh.vertices, collider_.pose.apply_inverse(x));
    found.at.point = collider_.pose.apply(found.at.point);
    return found;
  }

  const Collider& collider_;
  SurfaceView view_;
  std::vector<Aabb> fitted_;  // of what deforms, by node
};

/// Looks from the vertices of crossing triangles of `own` on to all that lie inside `other` with them.
class Search {
 public:
  Search(const Collider& own, BodyIndex own_body, const Collider& other, BodyIndex other_body, bool own_is_a)
      : own_(own, own_body), other_(other, other_body), own_is_a_(own_is_a), seen_(own.vertices.size(), 0) {}

  void start_at(int triangle) {
    for (const int v : own_.triangle(triangle)) visit(v);
  }

  void run(std::optional<Collision>& deepest) {
    InterruptPoll poll;
    while (!waiting_.empty()) {
      poll();
      const int v = waiting_.back();
      waiting_.pop_back();
      const std::optional<NearestTriangle> out = other_.if_inside(own_.vertex(v));
      if (!out) continue;
      const double depth = std::sqrt(out->at.squared_distance);
      if (depth > 0.0 && (!deepest || depth > -deepest->gap)) {
        if (!other_.winds_round(own_.vertex(v))) continue;
        deepest = contact(v, *out, depth);
      }
      for (const int t : own_.triangles_round(v))
        for (const int next : own_.triangle(t)) visit(next);
    }
  }

 private:
  void visit(int v) {
    if (seen_[v] != 0) return;
    seen_[v] = 1;
    waiting_.push_back(v);
  }

  Collision contact(int v, const NearestTriangle& out, double depth) const {
    const Vec3& x = own_.vertex(v);
    const Vec3 way = (out.at.point - x) / depth;
    const TriangleIndex own_triangle(own_.triangle_of({Feature::vertex, v})), other_triangle(out.triangle);
    Collision c;
    c.triangle_a = own_is_a_ ? own_triangle : other_triangle;
    c.triangle_b = own_is_a_ ? other_triangle : own_triangle;
    c.point_a = own_is_a_ ? x : out.at.point;
    c.point_b = own_is_a_ ? out.at.point : x;
    c.normal = own_is_a_ ? way : Vec3(-way);
    c.gap = -depth;
    c.feature = own_is_a_ ? feature_key(Feature::vertex, v, Feature::face, out.triangle)
                          : feature_key(Feature::face, out.triangle, Feature::vertex, v);
    return c;
  }

  SurfaceView own_;
  Surface other_;
  bool own_is_a_;
  std::vector<char> seen_;
  std::vector<int> waiting_;
};

}  // namespace

MeshOverlap find_overlap(std::span<const Collider> colliders, const BodyPair& pair,
                         std::span<const TrianglePair> triangles) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  std::vector<const TrianglePair*> crossing;
  InterruptPoll poll;
  for (const TrianglePair& t : triangles) {
    poll();
    const TriangleCorners of_a = corners_of(a, t.triangle_a), of_b = corners_of(b, t.triangle_b);
    if (overlap(bounds_of(of_a[0], of_a[1], of_a[2]), bounds_of(of_b[0], of_b[1], of_b[2])) &&
        triangles_intersect(of_a, of_b))
      crossing.push_back(&t);
  }
  if (crossing.empty()) return {};
  std::optional<Collision> deepest;
  Search a_in_b(a, pair.a, b, pair.b, true), b_in_a(b, pair.b, a, pair.a, false);
  for (const TrianglePair* t : crossing) a_in_b.start_at(t->triangle_a), b_in_a.start_at(t->triangle_b);
  a_in_b.run(deepest);
  b_in_a.run(deepest);
  if (deepest) deepest->body_a = pair.a, deepest->body_b = pair.b;
  return {true, deepest};
}

}  // namespace impinge
