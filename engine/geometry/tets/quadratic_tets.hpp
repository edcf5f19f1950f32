// Tetrahedra of ten nodes, four corners and six midpoints of edges, kept as a mesh of ordinary ones: each is cut into
// eight at its midpoints. So whatever carries points, finds neighbours or draws goes by the cut mesh and needs to know
// nothing of quadratic shape functions; only what asks for them puts the ten nodes together again.
#pragma once

#include "engine/geometry/tets/tet_mesh.hpp"

namespace impinge {

/// The corners, then the midpoints of the edges in the order of kTetEdges.
using QuadraticTet = std::array<int, 10>;

/// Tetrahedra that each is cut into: those of tetrahedron t are 8 t to 8 t + 7, the first four at its corners.
inline constexpr int kTetParts = 8;

/// The mesh with every tetrahedron cut into eight. Its vertices come first and keep their numbers; then one a midpoint,
/// in order of the tetrahedra. The octahedron in the middle is cut along its shortest diagonal.
TetMesh cut_at_midpoints(const TetMesh& mesh);

/// The ten nodes of tetrahedron `tet` of the mesh that was cut.
QuadraticTet quadratic_tet(const TetMesh& cut, int tet);
/// Corner k, or the midpoint of edge k − 4, in the weights of the four corners.
Vec4 quadratic_node_weights(int k);

/// Adds to `nodes` the midpoints between two corners that are among them.
void add_midpoints(const TetMesh& cut, std::vector<int>& nodes);

}  // namespace impinge
