// A body's part of the equations of its group: A, the free velocity, and what their solution says of it.
#pragma once

#include <variant>

#include "engine/algebra/block_matrix.hpp"
#include "engine/algebra/linear_solver.hpp"

namespace impinge {

/// A rigid body's part of A (block diagonal by body) and its velocities. A = diag(m I, R I_body R^T).
struct RigidBlock {
  double inverse_mass = 0.0;             ///< 1/kg
  Mat3 inverse_inertia = Mat3::Zero();   ///< world axes, 1/(kg·m²)
  Vec3 velocity = Vec3::Zero();          ///< v*, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  double rounding = 0.0;  ///< metres: all that touches is the skin of a ball or rod as thick, which rolls
};

/// A deformable body's part of A over its free nodes. Rows act on the velocity v at the end of the sub-step. Positions
/// move by Δq(v) = s v + d (integrators/): where a scheme's Δq is not Δt v (Newmark), what overlap is left after the
/// velocities is pushed out in the same sub-step, which sees displacement velocities Δq/Δt.
struct DeformableBlock {
  const BlockMatrix* a = nullptr;   ///< kg
  LinearSolver* solver = nullptr;   ///< analyzed with a's pattern; factorized when a response asks for it
  bool is_diagonal = false;         ///< a has nothing beside its diagonal blocks (explicit schemes, lumped mass)
  VecX velocity;                    ///< v*, 3 x free nodes, m/s
  VecX displacement_velocity;       ///< (s v* + d)/Δt, m/s
  double displacement_scale = 1.0;  ///< s/Δt
};

/// Of a body with freedom.
using SystemBlock = std::variant<RigidBlock, DeformableBlock>;

struct Twist {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  bool is_zero() const { return linear.isZero(0.0) && angular.isZero(0.0); }
  Twist& operator+=(const Twist& more) {
    linear += more.linear, angular += more.angular;
    return *this;
  }
};

/// A velocity or displacement of a body, in the unknowns of its block.
struct BodyVector {
  Twist twist;  ///< of a rigid body
  VecX nodes;   ///< of a deformable one, over its free nodes
};

}  // namespace impinge
