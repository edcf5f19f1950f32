// Stage 9 of a sub-step: the contacts of one group become A, J, v* and bounds.
#pragma once

#include <span>

#include "engine/bodies/rigid_body.hpp"
#include "engine/contact/collision.hpp"
#include "engine/contact/collision_groups.hpp"
#include "engine/contact/group_system.hpp"
#include "engine/integrators/integrator.hpp"
#include "engine/world/parameters.hpp"

namespace impinge {

/// Velocity of a body before the sub-step: what restitution reflects.
struct Twist {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// What a deformable body brings into a sub-step: its open system, the solver of its matrix, where it was.
struct SoftStep {
  DeformableStep step;
  std::unique_ptr<LinearSolver> iterative;  ///< for the one right-hand side of v*
  std::unique_ptr<LinearSolver> direct;     ///< for the many of contact
  VecX velocity_before;                     ///< over all nodes, m/s
  VecX displacement_velocity;               ///< (s v* + d)/Δt over all nodes, m/s: what contact and detection see
};

/// √(mu_A mu_B); a body that names none has the scene's.
double pair_friction(const RigidBody& a, const RigidBody& b, const Parameters& parameters);

/// The group's system at the bodies' free velocities. Row bound of a contact: J v >= -g0/Δt, raised to the rebound
/// -e·min(0, J v⁻) where the gap closes in this sub-step; for overlap that exists already 0 (push_out = "split"), or
/// the capped recovery speed (push_out = "velocity"). [Haapaoja16 §4.1], SPEC §3
/// `soft` has an entry a body, null for those that are not deformable. Contacts that nothing can respond to (of held nodes
/// with an immovable body) are taken out of the group.
GroupSystem make_group_system(std::span<const RigidBody> bodies, std::span<const Twist> before, std::span<const std::unique_ptr<SoftStep>> soft,
                              CollisionGroup& group, std::span<const Collision> collisions, const Parameters& parameters,
                              double time_step);

/// Where on a body's surface a point of a triangle is: weights of the triangle's corners.
Vec3 triangle_weights(const RigidBody& body, int triangle, const Vec3& point);

/// Whether any contact of the group overlaps enough to be pushed out.
bool needs_push_out(const GroupSystem& system, const Parameters& parameters);

/// The same group as a frictionless problem on pseudo-velocities from rest, solved after the velocities: overlapping
/// contacts separate by their overlap (at most max_push_out), the others may approach by no more than what is left of
/// their gap. Only positions follow from it, so pushing out makes no energy.
GroupSystem make_push_out_system(const GroupSystem& solved, const Parameters& parameters, double time_step);

}  // namespace impinge
