#include "engine/geometry/fitted_tree.hpp"

namespace impinge {
namespace {

constexpr double kDecay = 2.0;  // times the size when the tree was made

double size_of(const std::vector<Aabb>& boxes) {
  double sum = 0.0;
  for (const Aabb& box : boxes) sum += box.extent().norm();
  return sum;
}

}  // namespace

void FittedTree::fit(std::span<const Aabb> boxes) {
  if (tree_.order().size() == boxes.size()) {
    tree_.fit(boxes, boxes_);
    if (size_of(boxes_) <= kDecay * size_when_made_) return;
  }
  tree_ = BoxTree(boxes, leaf_);
  tree_.fit(boxes, boxes_);
  size_when_made_ = size_of(boxes_);
}

}  // namespace impinge
