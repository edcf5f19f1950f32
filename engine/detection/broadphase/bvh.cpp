// A hierarchy over the bodies' boxes, walked against itself. Its shape is kept from step to step and its boxes fitted,
// until they have grown so much that building it anew pays.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/geometry/fitted_tree.hpp"

namespace impinge {
namespace {

class Bvh final : public BroadPhase {
 public:
  void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) override {
    pairs.clear();
    sort_out(boxes);
    for (const int i : unbounded_)  // planes: there are few, and all is near them
      for (int j = 0; j < static_cast<int>(boxes.size()); ++j)
        if (overlap(boxes[i], boxes[j]) && i != j && (is_bounded_[j] || i < j))
          pairs.emplace_back(std::min(i, j), std::max(i, j));
    if (bounded_.size() > 1) {
      fitted_.fit(own_);
      walk(pairs);
    }
    std::sort(pairs.begin(), pairs.end());
  }

 private:
  void sort_out(std::span<const Aabb> boxes) {
    std::vector<int> bounded;
    unbounded_.clear();
    own_.clear();
    is_bounded_.assign(boxes.size(), false);
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
      is_bounded_[i] = boxes[i].min.allFinite() && boxes[i].max.allFinite();
      (is_bounded_[i] ? bounded : unbounded_).push_back(i);
      if (is_bounded_[i]) own_.push_back(boxes[i]);
    }
    if (bounded != bounded_) fitted_.forget();
    bounded_.swap(bounded);
  }

  void walk(std::vector<BoxPair>& pairs) const {
    const BoxTree& tree = fitted_.tree();
    const std::vector<Aabb>& box = fitted_.boxes();
    std::vector<std::pair<int, int>> waiting = {{0, 0}};
    InterruptPoll poll;
    while (!waiting.empty()) {
      const auto [a, b] = waiting.back();
      waiting.pop_back();
      poll();
      if (a != b && !overlap(box[a], box[b])) continue;
      const BoxTree::Node &na = tree.nodes()[a], &nb = tree.nodes()[b];
      if (na.is_leaf() && nb.is_leaf()) {
        if (a == b) continue;
        const int i = bounded_[tree.order()[na.first]], j = bounded_[tree.order()[nb.first]];
        pairs.emplace_back(std::min(i, j), std::max(i, j));
      } else if (a == b) {
        waiting.insert(waiting.end(), {{a + 1, a + 1}, {a + 1, na.second}, {na.second, na.second}});
      } else if (nb.is_leaf() || (!na.is_leaf() && box[a].extent().squaredNorm() >= box[b].extent().squaredNorm())) {
        waiting.insert(waiting.end(), {{a + 1, b}, {na.second, b}});
      } else {
        waiting.insert(waiting.end(), {{a, b + 1}, {a, nb.second}});
      }
    }
  }

  std::vector<int> bounded_, unbounded_;  // bodies
  std::vector<bool> is_bounded_;
  std::vector<Aabb> own_;  // of bounded bodies
  FittedTree fitted_{1};
};

}  // namespace

Entry<BroadPhase> bvh_broad_phase() {
  return entry<BroadPhase, Bvh>("bvh", "A hierarchy of boxes over the bodies, fitted as they move.");
}

}  // namespace impinge
