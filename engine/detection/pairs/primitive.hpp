// Contacts of pairs of which at least one body is no mesh: by the test of its own that the pair has (all.cpp), else by
// the forms of the two shapes.
#pragma once

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// How contacts are asked for; the same for every pair.
struct ContactQuery {
  bool proximity = true;     ///< false: only features that overlap (gap <= 0)
  double activation = 1e-3;  ///< metres
  double time_step = 0.0;    ///< seconds: features farther than `activation` count if they would meet within it
  /// Also what either body could come to at its speed, wherever it goes: of what strikes it in the sub-step it is stopped,
  /// or turned, on the way.
  bool either_may_stop = false;
  /// Metres: how far its weight alone moves a body in the time step, and has moved it already.
  Vec3 fall = Vec3::Zero(), sunk = Vec3::Zero();
};

/// Appends the contacts of body pair (a, b). Two meshes are the triangle search's, and not handed in here; every other
/// pair of shapes has an answer.
void primitive_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                        std::vector<Collision>& contacts);

}  // namespace impinge
