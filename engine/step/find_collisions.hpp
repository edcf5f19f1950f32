// Stage 6 of a sub-step: from pairs of bodies to collisions.
#pragma once

#include "engine/contact/contact_settings.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

/// What contacts are found by.
struct Detecting {
  const ContactSettings& contact;
  BroadPhase& broad_phase;
  NarrowPhase& narrow_phase;
  /// Of pairs with an exact shape: as ContactQuery has it, for responses that nothing is sought for anew.
  bool either_may_stop = false;
  /// Whether those that are apart and approach fast are told from those that will fly past each other.
  bool looks_ahead = false;
  /// Whether two that nothing else touches are looked at where they meet, and not where the sub-step begins.
  bool follows_flights = false;
  Vec3 gravity = Vec3::Zero();  ///< m/s²
};

/// Two rigid bodies that come near each other within the time step, and have nothing that is near before.
struct Approach {
  BodyPair pair;
  double time = 0.0;  ///< until then, s
};

/// Fills `triangle_pairs` of mesh-mesh pairs, sorted, and `collisions` in the order of `pairs`; and where it is asked for `approaches`,
/// likewise. time_step: s.
void find_collisions(std::span<const Collider> colliders, std::span<const BodyPair> pairs, const Detecting& by,
                     double time_step, std::vector<TrianglePair>& triangle_pairs, std::vector<Collision>& collisions,
                     std::vector<Approach>* approaches = nullptr);

/// The contacts of an approach where the two meet.
std::vector<Collision> collisions_of(const Approach& approach, std::span<const Collider> colliders, const Detecting& by,
                                     double time_step);

}  // namespace impinge
