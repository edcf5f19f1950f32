// Contacts that would stop what only moves past. Of two that are apart, a contact is one of the planes that may lie between
// them; one that the motion runs against says that they collide, which is wrong where another plane, along a face that the
// motion runs along, keeps them apart as well: what slides from one floor onto the next passes over its edge.
#pragma once

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// What a pair's contacts are judged by.
struct GhostQuery {
  double time_step = 0.0;   ///< seconds
  double activation = 0.0;  ///< metres; contacts beyond it count only if they close
  /// Metres: how its weight alone moves a body within the time step, though what it stands on will hold it.
  Vec3 fall = Vec3::Zero();
  Vec3 sunk = Vec3::Zero();  ///< likewise, how it has moved one already
  /// What answers leaves bodies a little below what carries them, and may drive them into whatever they approach.
  bool is_rough = false;
};

/// Of a pair's contacts from place `begin` on, those that close within the time step while a face beside their features
/// parts the two now and at the end of it become contacts of that face, or go where that is far. Not of planes.
void turn_ghost_contacts(std::span<const Collider> colliders, const BodyPair& pair, const GhostQuery& query,
                         std::size_t begin, std::vector<Collision>& contacts);

}  // namespace impinge
