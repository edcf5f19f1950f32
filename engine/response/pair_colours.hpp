// Colours of a graph: pairs of one colour have no body in common, so the order among them changes nothing, and threads
// may share them.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace impinge {

/// Two places in a list of bodies; -1: a body that nothing moves, which any number of pairs may touch.
using BodyPlaces = std::pair<int, int>;

struct PairColours {
  std::vector<int> order;  ///< the pairs, colour by colour, in each in their order
  std::vector<int> begin;  ///< of each colour in `order`, and the end
  /// The last colour holds what found none of its own: bodies of so many pairs. It has to be gone through one by one.
  bool last_is_rest = false;
};

/// Greedy, in the pairs' order. Pairs that rest on an immovable body come after all others: what a sweep does last is
/// what it does best, and nothing may sink into the ground.
PairColours colour_pairs(std::span<const BodyPlaces> pairs, int bodies);

}  // namespace impinge
