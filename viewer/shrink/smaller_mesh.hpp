// What a surface may be replaced by that has fewer triangles and stands in the same place.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Triangles that are connected by vertices, part by part, in order of their first ones.
std::vector<std::vector<int>> connected_parts(const TriangleMesh& mesh);
/// Those triangles, with the vertices that they use.
TriangleMesh with_triangles(const TriangleMesh& mesh, const std::vector<int>& triangles);

/// Fewest triangles first, all with fewer than the mesh: its box and its hull, new skins of a few cells if it is closed,
/// and itself with the vertices of each of a few cells made one.
std::vector<TriangleMesh> smaller_meshes(const TriangleMesh& mesh);

}  // namespace impinge
