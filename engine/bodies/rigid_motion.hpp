// The motion of one rigid body, the same in every integrator: A = M for rigid bodies.
#pragma once

#include "engine/bodies/rigid_body.hpp"

namespace impinge {

/// v* = v + kick g. The angular momentum does not change: gyroscopic torque does not enter A and b.
void apply_gravity(RigidBody& body, const Vec3& gravity, double kick);

/// The impulse of the pull in Δt, from the velocity that it leaves at the end: implicit, so it is stable, and wins no
/// energy, for any stiffness and Δt. The point moves on a straight line meanwhile. The force acts for `kick` seconds.
void apply_pull(RigidBody& body, const Pull& pull, double kick, double time_step);

/// Where the body would be after Δt with this velocity and angular momentum L: the centre moves by Δt v, the body turns
/// as it turns freely, exactly (free_rotation.hpp). Throws DivergenceError, without frame and name, where the turn is so
/// far (or not finite) that rounding leaves nothing of the attitude.
Pose free_flight(const RigidBody& body, const Vec3& velocity, const Vec3& angular_momentum, double time_step);

/// The attitude that the body has Δt after another one, likewise.
Mat3 free_turn(const RigidBody& body, const Mat3& attitude, const Vec3& angular_momentum, double time_step);

/// Moves the body by free_flight: contact changes L between two such turns, nothing within one. L is kept to the last
/// bit, the energy to rounding. [Haapaoja16 §2.1]
void advance_rigid(RigidBody& body, double time_step);

/// Turns and moves by a pseudo-velocity that changes no momentum (recovery from overlap).
void displace_rigid(RigidBody& body, const Vec3& displacement, const Vec3& turn);

}  // namespace impinge
