// Every box against every other, O(n²): the reference that all other broad phases must agree with.
#include "engine/core/interrupt.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {
namespace {

class BruteForce : public BroadPhase {
 public:
  bool tests_every_pair() const override { return true; }
  void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) override {
    pairs.clear();
    const int count = static_cast<int>(boxes.size());
    for (int i = 0; i < count; ++i) {
      check_interrupt();
      for (int j = i + 1; j < count; ++j)
        if (overlap(boxes[i], boxes[j])) pairs.emplace_back(i, j);
    }
  }
};

}  // namespace

Entry<BroadPhase> brute_force_broad_phase() {
  return entry<BroadPhase, BruteForce>("brute_force", "Every box against every other: the reference, O(n²).");
}

}  // namespace impinge
