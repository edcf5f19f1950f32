// A tree over boxes that move: its shape is kept and its boxes are fitted, until they have grown so much that building it
// anew pays.
#pragma once

#include "engine/geometry/box_tree.hpp"

namespace impinge {

class FittedTree {
 public:
  /// `leaf`: boxes of a leaf at most.
  explicit FittedTree(int leaf = 2) : leaf_(leaf) {}
  /// Another number of boxes starts anew; where other things take their places, forget() before.
  void fit(std::span<const Aabb> boxes);
  void forget() { tree_ = {}; }

  const BoxTree& tree() const { return tree_; }
  /// By node, where its boxes are now.
  const std::vector<Aabb>& boxes() const { return boxes_; }

 private:
  int leaf_;
  BoxTree tree_;
  std::vector<Aabb> boxes_;
  double size_when_made_ = 0.0;  // sum of the boxes' diagonals, metres
};

}  // namespace impinge
