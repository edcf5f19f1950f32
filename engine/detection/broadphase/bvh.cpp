// A hierarchy over the bodies' boxes, walked against itself. Its shape is kept from step to step and its boxes fitted,
// until they have grown so much that building it anew pays.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/geometry/box_tree.hpp"

namespace impinge {
namespace {

constexpr double kDecay = 1.5;  // times the boxes' sizes when the tree was made

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
      refresh();
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
    if (bounded != bounded_) tree_ = {};
    bounded_.swap(bounded);
  }

  double size() const {
    double sum = 0.0;
    for (const Aabb& box : fitted_) sum += box.extent().norm();
    return sum;
  }

  void refresh() {
    const bool is_new = tree_.is_empty();
    if (is_new) tree_ = BoxTree(own_, 1);
    tree_.fit(own_, fitted_);
    if (!is_new && !(size() <= kDecay * size_when_made_)) {
      tree_ = BoxTree(own_, 1);
      tree_.fit(own_, fitted_);
      size_when_made_ = size();
    }
    if (is_new) size_when_made_ = size();
  }

  void walk(std::vector<BoxPair>& pairs) const {
    std::vector<std::pair<int, int>> waiting = {{0, 0}};
    InterruptPoll poll;
    while (!waiting.empty()) {
      const auto [a, b] = waiting.back();
      waiting.pop_back();
      poll();
      if (a != b && !overlap(fitted_[a], fitted_[b])) continue;
      const BoxTree::Node &na = tree_.nodes()[a], &nb = tree_.nodes()[b];
      if (na.is_leaf() && nb.is_leaf()) {
        if (a == b) continue;
        const int i = bounded_[tree_.order()[na.first]], j = bounded_[tree_.order()[nb.first]];
        pairs.emplace_back(std::min(i, j), std::max(i, j));
      } else if (a == b) {
        waiting.insert(waiting.end(), {{a + 1, a + 1}, {a + 1, na.second}, {na.second, na.second}});
      } else if (nb.is_leaf() ||
                 (!na.is_leaf() && fitted_[a].extent().squaredNorm() >= fitted_[b].extent().squaredNorm())) {
        waiting.insert(waiting.end(), {{a + 1, b}, {na.second, b}});
      } else {
        waiting.insert(waiting.end(), {{a, b + 1}, {a, nb.second}});
      }
    }
  }

  std::vector<int> bounded_, unbounded_;  // bodies
  std::vector<bool> is_bounded_;
  std::vector<Aabb> own_, fitted_;  // of bounded bodies; of the tree's nodes
  BoxTree tree_;
  double size_when_made_ = 0.0;
};

}  // namespace

Entry<BroadPhase> bvh_broad_phase() {
  return entry<BroadPhase, Bvh>("bvh", "A hierarchy of boxes over the bodies, fitted as they move.");
}

}  // namespace impinge
