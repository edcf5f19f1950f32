// A triangle soup as sheets: neighbours face alike, each edge has two triangles or one, and the triangles round a
// vertex are one fan. Where that needs a cut, vertices are doubled; none moves.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct SheetCounts {
  int turned = 0;          ///< triangles that face the other way now
  int cut_edges = 0;       ///< edges with three triangles or more, or that no turning makes consistent
  int added_vertices = 0;  ///< copies, and middles of edges that would otherwise be one with another
  int unused = 0;          ///< vertices that no triangle had
};

/// Triangles keep their order and vertices theirs, copies stand beside the original. Of a connected part the larger
/// area keeps facing as it does. Round an edge with more than two triangles those are joined that have solid between
/// them, as the triangles' facing says. Without `orient` none is turned, and neighbours that face opposite ways stay.
/// No triangle names a vertex twice.
SheetCounts make_sheets(TriangleMesh& mesh, bool orient);

/// Per triangle the number of its connected part, by first triangles.
std::vector<int> label_parts(const TriangleMesh& mesh, const MeshTopology& topology, int& count);

}  // namespace impinge
