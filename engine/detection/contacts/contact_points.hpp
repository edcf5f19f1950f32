// From triangle pairs to contacts between two meshes: the two meanings of `contact.points`.
#pragma once

#include <algorithm>

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

inline bool any_crosses(std::span<const TrianglePair> triangles) {
  return std::any_of(triangles.begin(), triangles.end(), [](const TrianglePair& t) { return t.intersecting; });
}

/// Appends the contacts of one mesh-mesh body pair as the seed defines them [Haapaoja16 §3.2.3]: for each intersecting
/// triangle pair the deepest vertex and the point where a ray against its relative velocity meets the other triangle,
/// one contact for each vertex and face side. All gaps are <= 0.
void intersection_contacts(std::span<const Collider> colliders, const BodyPair& pair,
                           std::span<const TrianglePair> triangles, std::vector<Collision>& contacts);

/// Appends the proximity contacts of one mesh-mesh body pair: vertex-surface and edge-edge features closer than
/// `activation`, or that would meet within `time_step` at the colliders' velocities; gap > 0 while they are apart.
void proximity_contacts(std::span<const Collider> colliders, const BodyPair& pair,
                        std::span<const TrianglePair> triangles, double activation, double time_step,
                        std::vector<Collision>& contacts);

/// Of the proximity contacts of two different meshes, which stay, 1 or 0 by contact: all but crossings of two edges
/// between faces that deform and lie flat, where the ends of both edges have contacts of their own: between flat faces
/// those imply the crossing's.
std::vector<char> without_flat_crossings(std::span<const Collider> colliders, const BodyPair& pair,
                                         std::span<const Collision> contacts);

}  // namespace impinge
