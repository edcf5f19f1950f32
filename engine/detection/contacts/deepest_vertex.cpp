#include "engine/detection/contacts/deepest_vertex.hpp"

#include <cmath>
#include <limits>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/surface_view.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"
#include "engine/geometry/box_tree.hpp"

namespace impinge {
namespace {

struct Nearest {
  Vec3 point = Vec3::Zero();
  double squared_distance = std::numeric_limits<double>::infinity();
  int triangle = -1;
  TriangleFeature feature = TriangleFeature::face;
};

/// A surface that is asked for the point nearest to others: a rigid one by the tree it has in its own frame, one that
/// deforms by a tree for where it stands.
class Surface {
 public:
  Surface(const Collider& collider, BodyIndex body) : collider_(collider), view_(collider, body) {
    if (!view_.is_deforming()) return;
    here_ = BoxTree(triangle_boxes(mesh().triangles, collider.vertices));
  }

  /// The point of the surface nearest to x if x lies inside.
  std::optional<Nearest> if_inside(const Vec3& x) const {
    if (!overlap(collider_.bounds, Aabb{x, x})) return std::nullopt;
    Nearest found = nearest(view_.is_deforming() ? x : collider_.pose.apply_inverse(x));
    const Vec3 normal = view_.normal(view_.feature(found.triangle, found.feature));
    if (!view_.is_deforming()) found.point = collider_.pose.apply(found.point);
    return (x - found.point).dot(normal) < 0.0 ? std::optional(found) : std::nullopt;
  }

 private:
  const TriangleMesh& mesh() const { return collider_.mesh().mesh; }

  Nearest nearest(const Vec3& x) const {
    const BoxTree& tree = view_.is_deforming() ? here_ : collider_.mesh().tree();
    const std::span<const Vec3> vertices =
        view_.is_deforming() ? collider_.vertices : std::span<const Vec3>(mesh().vertices);
    Nearest best;
    std::vector<std::pair<double, int>> waiting = {{0.0, 0}};
    while (!waiting.empty()) {
      const auto [bound, n] = waiting.back();
      waiting.pop_back();
      if (bound >= best.squared_distance) continue;
      const BoxTree::Node& node = tree.nodes()[n];
      if (!node.is_leaf()) {
        std::pair<double, int> first = {squared_distance(tree.nodes()[n + 1].box, x), n + 1},
                               second = {squared_distance(tree.nodes()[node.second].box, x), node.second};
        if (second < first) std::swap(first, second);
        waiting.push_back(second);  // the nearer one is looked at first
        waiting.push_back(first);
        continue;
      }
      for (int i = node.first; i < node.first + node.count; ++i) {
        const int t = tree.order()[i];
        const Triangle& c = mesh().triangles[t];
        const PointTriangle p = closest_on_triangle(x, {vertices[c[0]], vertices[c[1]], vertices[c[2]]});
        if (p.squared_distance < best.squared_distance) best = {p.point, p.squared_distance, t, p.feature};
      }
    }
    return best;
  }

  const Collider& collider_;
  SurfaceView view_;
  BoxTree here_;
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
      const std::optional<Nearest> out = other_.if_inside(own_.vertex(v));
      if (!out) continue;
      const double depth = std::sqrt(out->squared_distance);
      if (depth > 0.0 && (!deepest || depth > -deepest->gap)) deepest = contact(v, *out, depth);
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

  Collision contact(int v, const Nearest& out, double depth) const {
    const Vec3& x = own_.vertex(v);
    const Vec3 way = (out.point - x) / depth;
    const TriangleIndex own_triangle(own_.triangle_of({Feature::vertex, v})), other_triangle(out.triangle);
    Collision c;
    c.triangle_a = own_is_a_ ? own_triangle : other_triangle;
    c.triangle_b = own_is_a_ ? other_triangle : own_triangle;
    c.point_a = own_is_a_ ? x : out.point;
    c.point_b = own_is_a_ ? out.point : x;
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
