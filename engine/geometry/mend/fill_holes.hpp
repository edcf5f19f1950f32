// Holes of a surface, closed by triangles between the vertices of their borders.
#pragma once

#include <span>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct Hole {
  std::vector<int> border;         ///< vertices in the order in which the filling runs through them
  std::vector<Triangle> filling;   ///< may name new vertices, from the mesh's number of vertices on
  std::vector<Vec3> new_vertices;  ///< a middle, where border vertices alone would double an edge
  double area = 0.0;               ///< of the filling, m²
};

/// The holes of a mesh that is made of sheets (sheets.hpp), by their smallest vertices. Small borders get the filling of
/// least area [Barequet95], long ones ears by their length. Nothing is added to the mesh.
std::vector<Hole> find_holes(const TriangleMesh& mesh, const MeshTopology& topology);

/// Adds the fillings to the mesh. `holes` as find_holes gave them, or some of them.
void fill(TriangleMesh& mesh, std::span<const Hole> holes);

}  // namespace impinge
