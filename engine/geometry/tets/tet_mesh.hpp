// A volume as tetrahedra.
#pragma once

#include <optional>

#include "engine/core/types.hpp"

namespace impinge {

/// Corner indices (a, b, c, d) of a tetrahedron with (b − a) · ((c − a) × (d − a)) > 0.
using Tet = std::array<int, 4>;

/// Vertices in source order (metres) and tetrahedra of positive volume.
struct TetMesh {
  std::vector<Vec3> vertices;
  std::vector<Tet> tets;
};

/// Corners of the face opposite corner k, counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// The six edges as pairs of corners.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// (b − a) · ((c − a) × (d − a)) / 6, m³: negative for an inverted tetrahedron.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
double tet_volume(const TetMesh& mesh, const Tet& tet);
double total_volume(const TetMesh& mesh);

/// Faces that belong to one tetrahedron only, counter-clockwise seen from outside, in order of tetrahedra. Vertex
/// indices are those of the mesh. Edges of such a boundary may be pinched: shared by four faces, not two.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh);

/// The first problem that keeps the mesh from being a body, worded to follow its name: no tetrahedra, an index out of
/// range, a corner named twice, a coordinate that isn't finite, a flat or inverted tetrahedron, a face shared by three
/// or more tetrahedra, a vertex in no tetrahedron. `tet_base` is added to the indices in the message (0 or 1, as the
/// file counts).
std::optional<std::string> check_tet_mesh(const TetMesh& mesh, int tet_base = 0);

/// How many parts the mesh has that share no vertex.
int component_count(const TetMesh& mesh);

/// Box [0, size] of nx × ny × nz cells, six tetrahedra a cell along the diagonal from its lowest to its highest corner
/// (Kuhn, Freudenthal). Vertex (i, j, k) has index (k (ny+1) + j) (nx+1) + i.
TetMesh make_tet_box(const Vec3& size, int nx, int ny, int nz);

/// The same box and vertices with five tetrahedra a cell, mirrored from cell to cell: a regular one in the middle, four
/// at its faces. No direction is favoured as by the diagonals of make_tet_box.
TetMesh make_alternating_box(const Vec3& size, int nx, int ny, int nz);

/// The smallest angle between two faces of a tetrahedron, degrees.
double smallest_dihedral_angle(const TetMesh& mesh, const Tet& tet);
/// Of all: the measure of a mesh's worst sliver.
double smallest_dihedral_angle(const TetMesh& mesh);

}  // namespace impinge
