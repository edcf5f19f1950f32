// How deep edges of one closed mesh run through another between their ends: what thin plates that cross like an X, or boxes
// edge on edge, overlap by while no vertex of either is inside the other. Used by nobody but judges.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/surface/searched_mesh.hpp"

namespace impinge {

/// Where an edge of a mesh meets a triangle of the other.
struct EdgeHit {
  int v0, v1;   ///< its vertices, the lower number first
  double t;     ///< 0 at v0, 1 at v1
  bool enters;  ///< from the triangle's front to its back, on the way from v0
};
/// Adds where the three edges of `own`, a triangle of `vertices`, meet `other`.
void add_edge_hits(const Triangle& own, std::span<const Vec3> vertices, const TriangleCorners& other,
                   std::vector<EdgeHit>& hits);

/// The deepest point inside closed `other` of the edges that are hit, metres; `known`, which no vertex is deeper than, if
/// they are not.
double deepest_of_edges(std::vector<EdgeHit> hits, std::span<const Vec3> vertices, const SearchedMesh& other,
                        double known);

}  // namespace impinge
