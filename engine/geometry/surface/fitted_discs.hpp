// A tree of discs over a surface that deforms: its shape is kept and its discs are fitted, until they have grown so much
// that making it anew pays.
#pragma once

#include "engine/geometry/surface/disc_tree.hpp"

namespace impinge {

class FittedDiscs {
 public:
  /// Another number of triangles starts anew.
  void fit(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
    if (tree_.order().size() == triangles.size()) {
      tree_.fit(triangles, vertices);
      if (tree_.size() <= kDecay * size_when_made_) return;
    }
    tree_ = DiscTree(triangles, vertices);
    size_when_made_ = tree_.size();
  }
  const DiscTree& tree() const { return tree_; }

 private:
  static constexpr double kDecay = 2.0;  // times the size when the tree was made

  DiscTree tree_;
  double size_when_made_ = 0.0;
};

}  // namespace impinge
