// An open surface as a thin solid, so that all that knows solids - contacts, continuous detection, the judge, pictures -
// knows it too.
#pragma once

#include <optional>
#include <string>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Which sides of an open surface are met.
enum class SurfaceSides {
  both,  ///< the solid reaches half its thickness to either side
  front  ///< the surface itself is met, from where its triangles run counter-clockwise; the solid lies behind it
};

struct ThinSurface {
  SurfaceSides sides = SurfaceSides::both;
  std::optional<double> thickness;  ///< metres; none: of the mean edge a thousandth (both), or half (front)

  double thickness_of(const TriangleMesh& mesh) const;
};

/// The closed surface round the thickened one: its triangles in their order, those of the other side, and the rim. Where
/// three or more triangles meet in an edge it is cut into parts that end there. For `both`, neighbours that face
/// opposite ways are turned alike, and cut where none can be (a Möbius strip). `mesh` satisfies check_indices. Vertices
/// move along the mean of their faces' normals, by the thickness at right angles to the faces or, at folds sharper than
/// a right angle, less.
TriangleMesh thickened(const TriangleMesh& mesh, const ThinSurface& how);

}  // namespace impinge
