// Contacts of pairs in which at least one body is an exact shape (or a box, which is a polyhedron): by formula.
#pragma once

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// How contacts are asked for; the same for every pair.
struct ContactQuery {
  bool proximity = true;     ///< false: only features that overlap (gap <= 0)
  double activation = 1e-3;  ///< metres
  double time_step = 0.0;    ///< seconds: features farther than `activation` count if they would meet within it
};

/// Appends the contacts of body pair (a, b), at least one of which is not a mesh.
void primitive_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                        std::vector<Collision>& contacts);

/// Whether primitive_contacts (or, for two meshes, the narrow phase) handles these two shapes.
bool is_pair_supported(const Shape& a, const Shape& b);

}  // namespace impinge
