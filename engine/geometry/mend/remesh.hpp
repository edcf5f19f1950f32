// A new skin round what a surface winds round: closed, oriented and without crossings whatever the surface was like, as
// exact as its cells are small.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Where the winding number passes 1/2 on a lattice of `cells` along the longest side, by marching tetrahedra [Doi91];
/// vertices lie where it does on the lattice's edges, so that a smooth surface is met to the square of a cell. Parts
/// thinner than a cell, and what is open on one side of it, may be lost. `walls`: a surface, open or not and facing either
/// way, that adds what it winds round. `largest_move`: the distance of a new vertex from the old surfaces, where that is
/// larger. Throws Interrupted.
TriangleMesh remesh(const TriangleMesh& surface, const TriangleMesh& walls, int cells, double* largest_move);

/// Bytes that takes at most.
double remesh_memory(const TriangleMesh& surface, int cells);

}  // namespace impinge
