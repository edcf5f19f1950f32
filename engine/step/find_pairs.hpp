// Stage 5 of a sub-step: which bodies may touch. Sleeping bodies cost nothing here until something that moves comes near.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/contact/contact_settings.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// Whether the pair can give a contact that anything responds to.
inline bool may_respond(const Bodies& bodies, BodyIndex a, BodyIndex b) {
  if (bodies[a].deleted || bodies[b].deleted) return false;
  return (bodies[a].has_freedom() || bodies[b].has_freedom()) && (bodies[a].is_moving() || bodies[b].is_moving()) &&
         !bodies.never_touch(a, b);
}

/// What detection sees of the bodies, at their free velocities. It refers to them. Of `colliders`, if they are as many, only
/// those of active bodies are made again.
void make_colliders(const Bodies& bodies, std::vector<Collider>& colliders);

/// The boxes that bodies sweep in a sub-step, each with half the activation distance round it.
struct SearchBoxes {
  std::vector<Aabb> by_body;
  double largest = 0.0;  ///< size of the largest body that moves freely, metres: a pair is no larger

  /// For the sub-step of time_step seconds; if they are as many as the colliders, only those of active bodies.
  void update(const Bodies& bodies, std::span<const Collider> colliders, const ContactSettings& settings,
              double time_step);
};
/// Pairs of overlapping boxes, by body, of which one moves, and maybe others: unique, in any order.
void find_moving_pairs(const Bodies& bodies, std::span<const Aabb> boxes, BroadPhase& broad_phase,
                       std::vector<BoxPair>& pairs);

/// How far surfaces of two bodies can approach in the sub-step, metres, where both can be; radii about their centres.
double approach(const Collider& a, double radius_a, const Collider& b, double radius_b, double time_step);
/// How far apart features of the two still are looked at, metres: the activation distance and how far they approach.
double search_margin(const Bodies& bodies, std::span<const Collider> colliders, BodyIndex a, BodyIndex b,
                     const ContactSettings& settings, double time_step);

/// Fills `pairs`, sorted, from the `boxes` that the bodies sweep in the sub-step of time_step seconds.
void find_pairs(const Bodies& bodies, std::span<const Collider> colliders, std::span<const Aabb> boxes,
                const ContactSettings& settings, double time_step, BroadPhase& broad_phase,
                std::vector<BodyPair>& pairs);

}  // namespace impinge
