// Boxes sorted along x; each is tested against those that begin before it ends.
#include <algorithm>
#include <numeric>

#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {
namespace {

class SortedAxis : public BroadPhase {
 public:
  void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) override {
    std::vector<int> order(boxes.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return boxes[l].min.x() < boxes[r].min.x(); });
    pairs.clear();
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t n = k + 1; n < order.size(); ++n) {
        const Aabb &a = boxes[order[k]], &b = boxes[order[n]];
        if (b.min.x() > a.max.x()) break;
        if (overlap(a, b)) pairs.push_back(std::minmax(order[k], order[n]));
      }
    std::sort(pairs.begin(), pairs.end());
  }
};

}  // namespace

Entry<BroadPhase> sorted_axis_broad_phase() {
  return entry<BroadPhase, SortedAxis>("sorted_axis", "Boxes sorted along x.");
}

}  // namespace impinge
