// How often a deformed tetrahedral mesh is wound round its inner edges.
//
// The tetrahedra round an inner edge close a ring, which at rest goes round once. However they are stretched or turned,
// it stays once while none of them is inverted; a mesh thrown about can be wound twice, or not at all, and no motion
// that keeps all volumes positive brings it back. So windings other than one tell a tangled mesh from a deformed one,
// also where every element has a positive volume.
#pragma once

#include "engine/geometry/tets/tet_mesh.hpp"

namespace impinge {

class TetWinding {
 public:
  TetWinding() = default;
  explicit TetWinding(const TetMesh& rest);

  int inner_edges() const { return static_cast<int>(edge_.size()); }
  /// End points of an inner edge, the smaller index first.
  const std::array<int, 2>& edge(int i) const { return edge_[i]; }
  /// Times that the ring of edge i goes round it, counted in the sense it has at rest, where it is 1. x: node by node
  /// x, y, z.
  int winding(const VecX& x, int i) const;

 private:
  std::vector<std::array<int, 2>> edge_;
  std::vector<int> begin_;                // of each edge's ring
  std::vector<std::array<int, 2>> ring_;  // the other two corners of each tetrahedron, in the sense of the ring
};

}  // namespace impinge
