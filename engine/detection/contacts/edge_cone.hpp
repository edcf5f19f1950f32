// A convex edge of a surface and the cone of directions that leave the surface there.
#pragma once

#include <optional>

#include "engine/detection/contacts/surface_view.hpp"

namespace impinge {

struct EdgeCone {
  int index = -1;
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();
  Vec3 into0 = Vec3::Zero(), into1 = Vec3::Zero();  ///< unit, into the faces beside it; the second zero at a border
  Vec3 normal = Vec3::Zero();                       ///< mean of the faces' normals, unit
  double slack = 0.0;                               ///< how far a direction may leave the cone, as a sine
  /// Whether `direction` (unit, away from the edge's body) leaves the edge between its two faces.
  bool is_outward(const Vec3& direction) const {
    return direction.dot(into0) <= slack && direction.dot(into1) <= slack && direction.dot(normal) > 0.0;
  }
};

/// The cone of edge e, or nothing where the edge is flat or concave: there no local minimum of distance lies inside it.
/// On a deforming surface nearly flat edges count, folded either way: nodes that move by a fraction of a step's way
/// turn such folds over, and a crossing that is a contact in one step and none in the next keeps stacked bodies
/// trembling.
std::optional<EdgeCone> make_edge_cone(const SurfaceView& view, int e);

/// Unit common normal of two edges, from b towards a, if it leaves both of them between their faces; nothing for
/// parallel edges.
std::optional<Vec3> common_normal(const EdgeCone& a, const EdgeCone& b);

}  // namespace impinge
