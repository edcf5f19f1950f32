// Every triangle against every triangle of the other body: the reference, and the baseline of the seed's Fig. 6.4.
#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

class BruteForce final : public NarrowPhase {
 public:
  bool tests_every_pair() const override { return true; }
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    found.clear();
    for (const BodyPair& pair : pairs) find_pair(colliders, pair, found);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }

 private:
  static constexpr std::size_t kRows = 32;  // triangles of a in one task

  static void make_boxes(const Collider& collider, double margin, std::vector<Aabb>& boxes) {
    boxes.resize(collider.mesh().mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
      boxes[t] = search_box(corners_of(collider, static_cast<int>(t)), margin);
  }

  void find_pair(std::span<const Collider> colliders, const BodyPair& pair, std::vector<TrianglePair>& found) {
    const Collider &a = colliders[pair.a], &b = colliders[pair.b];
    const bool is_self = pair.a == pair.b;
    make_boxes(a, pair.margin, boxes_a_);
    make_boxes(b, pair.margin, boxes_b_);
    const std::vector<Triangle>& triangles = a.mesh().mesh.triangles;
    const std::size_t count = boxes_a_.size(), tasks = (count + kRows - 1) / kRows;
    if (rows_.size() < tasks) rows_.resize(tasks);
    parallel_for(tasks, 1, [&](std::size_t task) {
      std::vector<TrianglePair>& out = rows_[task];
      out.clear();
      InterruptPoll poll;
      for (std::size_t i = task * kRows; i < std::min(count, (task + 1) * kRows); ++i) {
        const TriangleCorners corners = corners_of(a, static_cast<int>(i));
        const Aabb box = boxes_a_[i];
        for (std::size_t j = is_self ? i + 1 : 0; j < boxes_b_.size(); ++j) {
          poll();
          if (!overlap(box, boxes_b_[j])) continue;
          if (is_self && share_a_vertex(triangles[i], triangles[j])) continue;
          const int ta = static_cast<int>(i), tb = static_cast<int>(j);
          const PairState state = test_triangles(corners, corners_of(b, tb), pair.margin);
          if (state != PairState::apart)
            out.push_back({pair.a, pair.b, TriangleIndex(ta), TriangleIndex(tb), state == PairState::intersecting});
        }
      }
    });
    for (std::size_t task = 0; task < tasks; ++task) found.insert(found.end(), rows_[task].begin(), rows_[task].end());
  }

  std::vector<Aabb> boxes_a_, boxes_b_;
  std::vector<std::vector<TrianglePair>> rows_;
};

}  // namespace

Entry<NarrowPhase> brute_force_narrow_phase() {
  return entry<NarrowPhase, BruteForce>("brute_force",
                                        "Every triangle pair of a body pair; the reference the others must equal.");
}

}  // namespace impinge
