// A hierarchy of boxes over the triangles of a surface. Its shape is made once, for a mesh at rest; boxes of another pose
// or deformation are fitted to that shape from the leaves up.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/aabb.hpp"

namespace impinge {

class BoxTree {
 public:
  /// A node's first child follows it; a leaf has `count` triangles from `first` on, an inner node has none and its
  /// second child at `second`.
  struct Node {
    Aabb box;
    int second = -1;
    int first = 0, count = 0;
    bool is_leaf() const { return count > 0; }
  };

  BoxTree() = default;
  /// By halving at the middle of the boxes' centres along the longest axis, down to leaves of at most `leaf` boxes.
  explicit BoxTree(std::span<const Aabb> boxes, int leaf = 2);

  bool is_empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Which boxes are in the leaves, in their order.
  const std::vector<int>& order() const { return order_; }
  /// The nodes' boxes for other boxes of the same number, into `fitted`, by node.
  void fit(std::span<const Aabb> boxes, std::vector<Aabb>& fitted) const;

  /// Calls visit(box) for the boxes of every leaf that meets(node) lets through with all nodes above it.
  template <class Meets, class Visit>
  void search(Meets&& meets, Visit&& visit) const {
    if (is_empty()) return;
    std::vector<int> waiting = {0};
    while (!waiting.empty()) {
      const int n = waiting.back();
      waiting.pop_back();
      if (!meets(n)) continue;
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      if (node.is_leaf()) {
        for (int i = node.first; i < node.first + node.count; ++i) visit(order_[static_cast<std::size_t>(i)]);
      } else {
        waiting.push_back(node.second);
        waiting.push_back(n + 1);
      }
    }
  }

 private:
  std::vector<Node> nodes_;
  std::vector<int> order_;
};

/// Boxes of triangles whose corners stand at `vertices`.
std::vector<Aabb> triangle_boxes(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

}  // namespace impinge
