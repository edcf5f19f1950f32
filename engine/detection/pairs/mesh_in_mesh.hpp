// A mesh that lies inside another: no triangles meet, or only where it comes out, so nothing else would notice.
#pragma once

#include "engine/detection/pairs/primitive.hpp"

namespace impinge {

/// Whether the box of a body lies in that of a mesh that encloses something.
bool may_be_inside(const Collider& mesh, const Collider& body);

/// Whether the one mesh of a pair is inside what the other encloses, or a much smaller one is deep in it; then appends one
/// contact, along the shortest way out for one of its points, and features have nothing to say. `triangles`: those of the
/// pair that are near.
bool mesh_in_mesh(std::span<const Collider> colliders, const BodyPair& pair, std::span<const TrianglePair> triangles,
                  const ContactQuery& query, std::vector<Collision>& contacts);

}  // namespace impinge
