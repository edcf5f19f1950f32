// Sweep and prune [Haapaoja16 §3.1]. Boxes that hardly move from frame to frame are followed by insertion sort of three
// endpoint lists, O(n + s) for s swaps. In a crowd of n evenly spread boxes s grows like n^(5/3) even for slow motion
// (every box passes a share of all others on each axis), and turning every end round costs n²; so the number of swaps
// is bounded and beyond it a full sort and sweep takes over, which costs the same for any motion.
#include <algorithm>
#include <cmath>

#include "engine/detection/broadphase/endpoint_lists.hpp"
#include "engine/detection/broadphase/pruned_sweep.hpp"

namespace impinge {
namespace {

/// Swaps a box that cost as much as the full sweep (measured: about 15 ns a swap, 200 ns a box), and so the bound.
constexpr double kSwapsPerBox = 12.0;
/// Frames without an attempt after one that was given up; doubles each time up to the second number.
constexpr int kPatience = 8, kMaxPatience = 1024;

class SweepAndPrune : public BroadPhase {
 public:
  void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) override {
    if (boxes.size() != before_.size() || !follow(boxes)) {
      sweep_.find(boxes, found_);
      if (boxes.size() != before_.size()) {
        followed_ = false;
        wait_ = 0;
        patience_ = kPatience;
      } else if (!followed_ && worth_following(boxes)) {
        lists_.build(boxes);
        followed_ = true;
      }
    }
    before_.assign(boxes.begin(), boxes.end());
    pairs = found_;
  }

 private:
  double max_swaps() const { return kSwapsPerBox * static_cast<double>(before_.size()); }

  /// Brings found_ from the last frame's boxes to these; false if that isn't possible or not worth it.
  bool follow(std::span<const Aabb> boxes) {
    if (!followed_) return false;
    if (!lists_.update(before_, boxes, static_cast<std::size_t>(max_swaps()))) {
      followed_ = false;
      wait_ = patience_;
      patience_ = std::min(2 * patience_, kMaxPatience);
      return false;
    }
    patience_ = kPatience;
    if (lists_.begun().empty() && lists_.ceased().empty()) return true;
    merged_.clear();
    auto begun = lists_.begun().begin();
    const auto begun_end = lists_.begun().end();
    auto ceased = lists_.ceased().begin();
    for (const BoxPair& pair : found_) {
      while (begun != begun_end && *begun < pair) merged_.push_back(*begun++);
      if (ceased != lists_.ceased().end() && *ceased == pair)
        ++ceased;
      else
        merged_.push_back(pair);
    }
    merged_.insert(merged_.end(), begun, begun_end);
    found_.swap(merged_);
    return true;
  }

  /// Whether the motion since the last frame would have cost fewer swaps than half the bound, were the ends evenly
  /// spread: 2n ends an axis over its extent, each passing those within its displacement.
  bool worth_following(std::span<const Aabb> boxes) {
    if (wait_ > 0) {
      --wait_;
      return false;
    }
    double swaps = 0.0;
    const double n = static_cast<double>(boxes.size());
    for (int axis = 0; axis < 3; ++axis) {
      double low = 1e300, high = -1e300, moved = 0.0;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const double x0 = boxes[i].min[axis], x1 = boxes[i].max[axis], d = std::abs(x0 - before_[i].min[axis]);
        if (!std::isfinite(x0) || !std::isfinite(x1) || !std::isfinite(d)) continue;
        low = std::min(low, x0);
        high = std::max(high, x1);
        moved += d;
      }
      if (high > low) swaps += 2.0 * n * moved / (high - low);
    }
    return swaps < 0.5 * max_swaps();
  }

  PrunedSweep sweep_;
  EndpointLists lists_;
  std::vector<Aabb> before_;
  std::vector<BoxPair> found_, merged_;
  bool followed_ = false;  ///< lists_ hold the ends of before_
  int wait_ = 0, patience_ = kPatience;
};

}  // namespace

Entry<BroadPhase> sweep_and_prune_broad_phase() {
  return entry<BroadPhase, SweepAndPrune>(
      "sweep_and_prune", "Sorted box ends, followed from frame to frame; a full sweep when much has moved.");
}

}  // namespace impinge
