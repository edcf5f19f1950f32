// Whether a triangle mesh can be the surface of a solid, and what to do when it can't.
#pragma once

#include <optional>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// The first problem that even make_topology can't take (no triangles, a coordinate that isn't finite, an index out of
/// range, a triangle that names a vertex twice), worded to follow the mesh's name, with a remedy; nothing if there is
/// none.
std::optional<std::string> check_indices(const TriangleMesh& mesh);

/// The first problem of its triangles and edges, in this order: those of check_indices, edges with three or more
/// triangles, border edges, neighbours of opposite orientation. What has none has two sides, whichever is the inner one.
std::optional<std::string> check_closed(const TriangleMesh& mesh, const MeshTopology& topology);

/// The first problem that keeps the mesh from bounding a solid: those of check_closed, a shell that faces the wrong way
/// (see check_shells), no volume. Worded to follow the mesh's name ("is not closed: 3 border edges, first between vertices 0
/// and 7; ..."), with a remedy.
std::optional<std::string> check_mesh(const TriangleMesh& mesh, const MeshTopology& topology);

/// A mesh whose vertices of exactly equal position are one.
struct WeldedMesh {
  TriangleMesh mesh;
  std::vector<int> new_vertex;    ///< new index of each old vertex
  std::vector<int> old_triangle;  ///< old index of each new triangle (those left with two equal corners are gone)
};

/// Vertices of equal coordinates (0 equals -0) become the first of them; the order is kept. No tolerance: files repeat
/// a vertex with the same digits, and a tolerance could close gaps that are meant.
WeldedMesh weld(const TriangleMesh& mesh);

}  // namespace impinge
