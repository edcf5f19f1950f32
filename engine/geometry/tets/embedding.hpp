// Points carried by a tetrahedral mesh: each lies in a tetrahedron and moves with its four corners.
#pragma once

#include <span>

#include "engine/geometry/tets/tet_mesh.hpp"

namespace impinge {

struct Embedding {
  std::vector<int> tet;      ///< of each point
  std::vector<Vec4> weight;  ///< barycentric, sum 1; slightly negative for a point outside the mesh
  int outside = 0;           ///< points in no tetrahedron: carried by the nearest one
  double farthest = 0.0;     ///< smallest weight found, as a positive number; 0 when all points are inside
};

/// Barycentric weights of p in the tetrahedron a, b, c, d of nonzero volume.
Vec4 barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Where each point lies in the mesh. A grid over the tetrahedra makes this a few tests a point.
Embedding embed(const TetMesh& mesh, std::span<const Vec3> points);

/// Positions of the points for the nodes' positions or velocities `x` (x, y, z each).
void interpolate(const Embedding& embedding, const TetMesh& mesh, const VecX& x, std::vector<Vec3>& points);

}  // namespace impinge
