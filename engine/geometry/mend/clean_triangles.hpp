// The first steps of mending: vertices that are meant to be one become one, and triangles that bound nothing go.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Vertices on borders that are no farther apart than `tolerance`, metres, become the first of them; triangles that lose
/// a corner by that go. Inner vertices stay: welding them would only make sheets touch that don't.
struct BorderWeld {
  int welded = 0, collapsed = 0;  ///< vertices and triangles that went
  double largest_move = 0.0;      ///< metres
};
BorderWeld weld_borders(TriangleMesh& mesh, double tolerance);

/// The part's triangles after the mesh's own, with vertices of their own.
void append(TriangleMesh& mesh, const TriangleMesh& part);

/// How near to each other border vertices are that are one, metres: `least`, or the smallest of up to a thousand times that
/// with which welding leaves the fewest border edges, less than half of those that `least` leaves, and takes no triangle.
/// Corners of triangles that were each rounded by themselves lie as far apart as the file's digits.
double closing_tolerance(const TriangleMesh& mesh, double least);

/// Removes triangles that name a vertex twice. How many.
int drop_collapsed(TriangleMesh& mesh);

/// Of triangles with the same three corners one stays: the first, where it belongs to the skin, and none where the
/// copies face opposite ways between two solids, as a wall inside of their union. How many went.
int drop_duplicates(TriangleMesh& mesh);

/// Of edges without length one end stays, where the surface without the edge is one of the same kind: the two triangles
/// beside it, which have no area, go. How many edges.
int join_coincident(TriangleMesh& mesh);

/// Triangles whose corners lie on a line: the one in the middle is joined to the far corner of the neighbour across the
/// long side, so that no vertex moves and no hole is left. How many.
int flip_flat(TriangleMesh& mesh);

}  // namespace impinge
