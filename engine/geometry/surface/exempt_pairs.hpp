// Pairs of a surface's own triangles that are never held against each other, as they are near each other by design:
// shells that overlap in the rest state, the folds of a sleeve.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class ExemptPairs {
 public:
  /// The pairs that share no vertex and are no farther apart than `distance`, metres, or cross.
  ExemptPairs(const SurfaceMesh& surface, double distance);

  std::size_t size() const { return pairs_.size(); }
  bool has(int s, int t) const;
  /// Whether a triangle round the vertex and the other one are such a pair.
  bool has_vertex(const MeshTopology& topology, int vertex, int t) const;
  /// Whether triangles on the two edges are.
  bool has_edges(const MeshTopology& topology, int e, int f) const;

 private:
  std::vector<std::uint64_t> pairs_;  // sorted, the lower index first
};

}  // namespace impinge
