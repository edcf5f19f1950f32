// A hierarchy of flat discs over the triangles of a surface: of each part a ball and a box round it and the slab, at right
// angles to its mean normal, that it lies in. A part of a smooth surface is thinner by the square of its size, so two surfaces that
// run along each other are told apart by parts far larger than their distance, where boxes along given axes would have to
// be as small [GottschalkLin96]; and turned, a disc is as tight as before.
//
// Every node holds four discs, side by side for FourFloats. Nodes lie by level: those below disc k of node j of a level
// are discs of node 4j + k of the next, and those of the last level are triangles, 4j + k of the order. All but the last
// node of a level are full, so nothing has to say where a node's children are.
//
// Discs are floats, in a frame whose origin is the middle of the surface, and hold their triangles in spite of rounding.
// A normal of 0 says that nothing is known of it: ball and box stand alone.
#pragma once

#include <algorithm>
#include <span>

#include "engine/core/lazily.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class NormalCones;

class DiscTree {
 public:
  struct alignas(16) Node {
    float center[3][4], normal[3][4];
    float half[3][4];    ///< of the box round it along the frame's axes, about the centre
    float thickness[4];  ///< half of the slab's
    float radius[4];
  };

  DiscTree() = default;
  /// Its shape by halving at the middle along the longest axis, as `vertices` lie; the discs round where they are.
  DiscTree(std::span<const Triangle> triangles, std::span<const Vec3> vertices);
  /// The discs for other places of the vertices.
  void fit(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

  int levels() const { return static_cast<int>(begin_.size()) - 1; }
  int triangle_count() const { return static_cast<int>(order_.size()); }
  int node_count(int level) const { return begin_[level + 1] - begin_[level]; }
  const Node& node(int level, int j) const { return nodes_[static_cast<std::size_t>(begin_[level] + j)]; }
  /// How many discs a node holds.
  int disc_count(int level, int j) const {
    const int all = level + 1 < levels() ? begin_[level + 2] - begin_[level + 1] : triangle_count();
    return std::min(4, all - 4 * j);
  }
  /// Which triangles the discs of the last level hold, in their order.
  const std::vector<int>& order() const { return order_; }
  /// Where the discs' frame has its origin.
  const Vec3& origin() const { return origin_; }
  /// What a coordinate in that frame amounts to at most.
  double reach() const { return reach_; }
  /// How large the discs above the triangles are, all in all.
  double size() const;

  Lazily<NormalCones> lazy_cones = {};  ///< of the mesh it was made for: normal_cones.hpp

 private:
  void fit_triangles(int j, std::span<const Triangle> triangles, std::span<const Vec3> vertices);
  void fit_disc(int level, int j, int k);

  std::vector<Node> nodes_;
  std::vector<int> begin_;  // by level, and the number of nodes
  std::vector<int> order_;
  Vec3 origin_ = Vec3::Zero();
  double reach_ = 0.0;
  float rounding_ = 0.0f;  // metres, what a coordinate is off at most, generously
};

}  // namespace impinge
