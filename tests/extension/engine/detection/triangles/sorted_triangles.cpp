// The triangles of one body sorted along x; each of the other is tested against those that begin before it ends.
#include <algorithm>

#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

class SortedTriangles : public NarrowPhase {
 public:
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    found.clear();
    for (const BodyPair& pair : pairs) find_pair(colliders[pair.a], colliders[pair.b], pair, found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

 private:
  using Sorted = std::vector<std::pair<Aabb, int>>;

  static Sorted boxes_of(const Collider& collider, double margin) {
    Sorted boxes;
    for (int t = 0; t < static_cast<int>(collider.mesh().mesh.triangles.size()); ++t)
      boxes.emplace_back(search_box(corners_of(collider, t), margin), t);
    return boxes;
  }

  static void find_pair(const Collider& a, const Collider& b, const BodyPair& pair, std::vector<TrianglePair>& found) {
    const std::vector<Triangle>& triangles = a.mesh().mesh.triangles;
    Sorted others = boxes_of(b, pair.margin);
    std::sort(others.begin(), others.end(),
              [](const auto& l, const auto& r) { return l.first.min.x() < r.first.min.x(); });
    for (const auto& [box, i] : boxes_of(a, pair.margin))
      for (const auto& [other, j] : others) {
        if (other.min.x() > box.max.x()) break;
        if (!overlap(box, other)) continue;
        if (pair.a == pair.b && (j <= i || share_a_vertex(triangles[i], triangles[j]))) continue;
        const PairState state = test_triangles(corners_of(a, i), corners_of(b, j), pair.margin);
        if (state != PairState::apart)
          found.push_back({pair.a, pair.b, TriangleIndex(i), TriangleIndex(j), state == PairState::intersecting});
      }
  }
};

}  // namespace

Entry<NarrowPhase> sorted_triangles_narrow_phase() {
  return entry<NarrowPhase, SortedTriangles>("sorted_triangles", "Triangles sorted along x.");
}

}  // namespace impinge
