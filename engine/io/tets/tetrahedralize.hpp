// Tetrahedra that fill a closed surface, made by a program of its own: impinge-tetrahedralize
// (scenes/meshes/tetrahedralize).
//
// It stands apart because the library it uses is under another licence, large, and slow to compile; nothing of it is
// linked into impinge.
#pragma once

#include <filesystem>

#include "engine/geometry/tets/tet_mesh.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct TetrahedralizeSettings {
  double max_size = 0.1;    ///< longest edge that is aimed at, metres; few exceed it
  double min_angle = 10.0;  ///< smallest angle between two faces of a tetrahedron that is aimed at, degrees
};

/// What IMPINGE_TETRAHEDRALIZE names; else beside the running program, else in PATH. Empty where there is none.
std::filesystem::path find_tetrahedralizer();

/// The tetrahedra, checked like those of a file. Their boundary follows the surface to within a tenth of max_size,
/// edges and corners rounded. Throws InputError (without a place) where the program isn't there or fails, with what it
/// said.
TetMesh tetrahedralize(const TriangleMesh& surface, const TetrahedralizeSettings& settings);

}  // namespace impinge
