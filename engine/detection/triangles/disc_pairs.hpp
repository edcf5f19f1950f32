// Triangle pairs by trees of discs. A rigid mesh has one tree for good, in its own frame, so that nothing is made anew
// when it moves; a deforming mesh's tree keeps the shape it had when it was made, its discs are fitted.
#pragma once

#include <span>

#include "engine/detection/triangles/tree_pairs.hpp"
#include "engine/geometry/surface/disc_walk.hpp"
#include "engine/geometry/surface/fitted_discs.hpp"

namespace impinge {

class DiscPairs {
 public:
  /// As NarrowPhase::find.
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs, std::vector<TrianglePair>& found);

 private:
  /// A part of the walk of one pair, and what it comes to.
  struct Part {
    int pair;
    std::vector<DiscWalk::Task> tasks;
    std::vector<std::uint64_t> found;
  };

  void prepare(std::span<const Collider> colliders, std::span<const BodyPair> pairs);
  void open(std::span<const Collider> colliders, std::span<const BodyPair> pairs, int pair,
            std::vector<Part>& parts) const;
  void walk(std::span<const Collider> colliders, const BodyPair& pair, Part& part) const;

  std::vector<const DiscTree*> trees_;  // by body
  std::vector<FittedDiscs> fitted_;     // by body
  std::vector<DiscWalk> walks_;         // by pair
};

}  // namespace impinge
