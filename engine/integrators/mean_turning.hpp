// How a deformable body turns as a whole.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

class DeformableBody;

/// The angular velocity that a rigid body with its places, masses and angular momentum would have, rad/s.
Vec3 mean_turning(const DeformableBody& body);

/// How far a scheme turns a rigid body that turns at ω, in h seconds.
enum class TurningRule {
  exact,    ///< ω h
  midpoint  ///< 2 atan(ω h/2): x₁ − x₀ = h ω × (x₀ + x₁)/2
};

/// The velocities (x₁ − x₀)/h with which the nodes go on as a rigid body for h seconds, m/s; empty where nodes are held.
VecX rigid_motion(const DeformableBody& body, double h, TurningRule rule);

}  // namespace impinge
