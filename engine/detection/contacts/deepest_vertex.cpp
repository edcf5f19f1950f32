#include "engine/detection/contacts/deepest_vertex.hpp"

#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/deepest_edge.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

/// Looks from the vertices of crossing triangles of `own` on to all that lie inside `other` with them.
class Search {
 public:
  Search(const Collider& own, const SurfaceView& view, const EnclosingSurface& other, bool own_is_a)
      : own_(view), other_(other), own_is_a_(own_is_a), seen_(own.vertices.size(), 0) {}

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
        deepest = contact_inside(own_, {Feature::vertex, v}, own_.vertex(v), *out, own_is_a_);
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

  const SurfaceView& own_;
  const EnclosingSurface& other_;
  bool own_is_a_;
  std::vector<char> seen_;
  std::vector<int> waiting_;
};

}  // namespace

MeshOverlap find_overlap(std::span<const Collider> colliders, const BodyPair& pair,
                         std::span<const TrianglePair> triangles, double least_of_edges) {
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
  const EnclosingSurface surface_a(a, pair.a), surface_b(b, pair.b);
  Search a_in_b(a, surface_a.view(), surface_b, true), b_in_a(b, surface_b.view(), surface_a, false);
  for (const TrianglePair* t : crossing) a_in_b.start_at(t->triangle_a), b_in_a.start_at(t->triangle_b);
  a_in_b.run(deepest);
  b_in_a.run(deepest);
  std::optional<Collision> edge;
  if (std::isfinite(least_of_edges)) {
    const double known = std::max(least_of_edges, deepest ? -deepest->gap : 0.0);
    find_deepest_edge(surface_a, surface_b, crossing, true, known, edge);
    find_deepest_edge(surface_b, surface_a, crossing, false, known, edge);
  }
  for (std::optional<Collision>* c : {&deepest, &edge})
    if (*c) (*c)->body_a = pair.a, (*c)->body_b = pair.b;
  return {true, deepest, edge};
}

}  // namespace impinge
