// Broad phase: which bodies' boxes overlap. [Haapaoja16 §3.1]
#pragma once

#include <span>
#include <utility>

#include "engine/core/method.hpp"
#include "engine/core/registry.hpp"
#include "engine/geometry/aabb.hpp"

namespace impinge {

/// Index pair (i, j), i < j.
using BoxPair = std::pair<int, int>;

class BroadPhase : public Method {
 public:
  /// All pairs of overlapping boxes (closed: touching counts), sorted and unique, into `pairs`. Boxes may be infinite
  /// (planes) but not NaN. Called once a sub-step with the boxes in the same order; a change of their number starts
  /// anew. The answer depends on `boxes` alone: what an implementation keeps from the last call only makes it faster.
  virtual void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs) = 0;
  /// Whether nothing is spared: what the others are held against.
  virtual bool tests_every_pair() const { return false; }
};

const Registry<BroadPhase>& broad_phases();

}  // namespace impinge
