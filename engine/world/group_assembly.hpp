// Stage 9 of a sub-step: the contacts of one group become A, J, v* and bounds.
#pragma once

#include <span>

#include "engine/contact/collision_groups.hpp"
#include "engine/contact/group_system.hpp"
#include "engine/detection/collision.hpp"
#include "engine/world/attachments.hpp"
#include "engine/world/parameters.hpp"
#include "engine/world/soft_step.hpp"

namespace impinge {

/// Velocity of a body before the sub-step: what restitution reflects.
struct Twist {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// What stage 9 reads.
struct SubstepView {
  std::span<const RigidBody> bodies;
  std::span<const Twist> before;
  std::span<const std::unique_ptr<SoftStep>> soft;  ///< a slot a body; null: not deformable
  std::span<const Collision> collisions;            ///< a group's contact i is collision i, and after the last one
  std::span<const Attachment> attachments;          ///< attachment i - collisions.size()
  const Parameters& parameters;
  double time_step = 0.0;    ///< s
  bool is_explicit = false;  ///< the integrator's A is M
};

/// √(mu_A mu_B); a body that names none has the scene's.
double pair_friction(const RigidBody& a, const RigidBody& b, const Parameters& parameters);

/// The group's system at the bodies' free velocities. Row bound of a contact: J v >= -g0/Δt, raised to the rebound
/// -e·min(0, J v⁻) where the gap closes in this sub-step; for overlap that exists already 0 (push_out = "split"), or
/// the capped recovery speed (push_out = "velocity"). [Haapaoja16 §4.1] An attachment asks J v = -(x_A -
/// x_B)/Δt. Contacts that nothing can respond to (of held nodes with an immovable body) are taken out of the group.
GroupSystem make_group_system(const SubstepView& view, CollisionGroup& group);

/// Where on a body's surface a point of a triangle is: weights of the triangle's corners.
Vec3 triangle_weights(const RigidBody& body, int triangle, const Vec3& point);

/// Whether any contact of the group overlaps, or will after the sub-step, enough to be pushed out.
bool needs_push_out(const GroupSystem& solved, const Parameters& parameters, double time_step);

/// The same group as a frictionless problem on pseudo-velocities from rest, solved after the velocities: overlapping
/// contacts separate by their overlap (at most max_push_out), the others may approach by no more than what is left of
/// their gap. Only positions follow from it, so pushing out makes no energy.
GroupSystem make_push_out_system(const GroupSystem& solved, const Parameters& parameters, double time_step);

}  // namespace impinge
