// Tetrahedra as lines and as small solids.
#pragma once

#include <span>

#include "engine/geometry/tets/tet_mesh.hpp"
#include "viewer/draw/shaded_surface.hpp"

namespace impinge {

/// Edges of a tetrahedral mesh, each once, as pairs of nodes (the smaller first), ascending.
struct TetEdges {
  std::vector<std::array<int, 2>> outer, inner;  ///< outer: of faces that belong to one tetrahedron only
};
TetEdges make_tet_edges(const TetMesh& mesh);

/// Every chosen tetrahedron shrunk about its centre by the factor, as four flat faces seen from outside (of a
/// tetrahedron that is turned inside out too); triangle 4 i + k is face k of tetrahedron which[i]. Positions: node by
/// node x, y, z; the result is relative to `origin`.
ShadedSurface shrunk_tets(const TetMesh& mesh, const VecX& positions, std::span<const int> which, double factor,
                          const Vec3& origin);

}  // namespace impinge
