// Where the pieces of a surface end that the nodes of its tree hold. A piece and a fan over its rim look the same from outside
// the box round the piece: they close a surface that lies in the box. So the solid angle of many triangles is that of the
// few edges of their rim, exactly [Jacobson13 §4].
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/geometry/box_tree.hpp"

namespace impinge {

/// Of a mesh and its tree, for every pose and deformation.
class NodeRims {
 public:
  using Edge = std::array<int, 2>;  ///< as a triangle of the piece runs along it

  NodeRims(const BoxTree& tree, std::span<const Triangle> triangles);

  /// Where the node's triangles stand in the tree's order.
  int begin(int node) const { return nodes_[static_cast<std::size_t>(node)].begin; }
  int end(int node) const { return nodes_[static_cast<std::size_t>(node)].end; }
  /// Whether the node has a rim that is worth looking at instead of its triangles: of a soup of triangles none is.
  bool has_rim(int node) const { return nodes_[static_cast<std::size_t>(node)].first_edge >= 0; }
  /// Edges that others of the piece don't run back along, each as often as that; of a closed piece none.
  std::span<const Edge> rim(int node) const {
    const Node& own = nodes_[static_cast<std::size_t>(node)];
    return {edges_.data() + own.first_edge, static_cast<std::size_t>(own.edges)};
  }

 private:
  struct Node {
    int begin = 0, end = 0;
    int first_edge = -1, edges = 0;
  };
  std::vector<Edge> make(const BoxTree& tree, std::span<const Triangle> triangles, int node);

  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
};

}  // namespace impinge
