// One collision group as a system of equations: A by body, J by contact, the free velocity v* and the rows' bounds.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// A rigid body's part of A (block diagonal by body) and its velocities. A = diag(m I, R I_body R^T).
struct BodyBlock {
  double inverse_mass = 0.0;             ///< 1/kg
  Mat3 inverse_inertia = Mat3::Zero();   ///< world axes, 1/(kg·m²)
  Vec3 velocity = Vec3::Zero();          ///< v*, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
};

/// Rows (n, t1, t2) of J for one contact. Both bodies act at one common point, or impulses would not keep angular
/// momentum. A row is [ d^T  (r_A x d)^T  -d^T  -(r_B x d)^T ] for each direction d. [Haapaoja16 Eq. 4.11]
struct ContactRows {
  int a = -1, b = -1;              ///< index into GroupSystem::bodies, -1: the body has no degree of freedom
  Mat3 directions = Mat3::Zero();  ///< rows n^T, t1^T, t2^T
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< from the centre of mass to the common point
  Vec3 surface = Vec3::Zero();     ///< what bodies without freedom add to J v (their given velocity), along the rows
  double gap = 0.0;                ///< g0, metres
  double bound = 0.0;              ///< J v >= bound along n, m/s
  double friction = 0.0;           ///< 0: the contact has no tangential rows
};

struct GroupSystem {
  std::vector<BodyBlock> bodies;
  std::vector<ContactRows> contacts;
  std::vector<Vec3> lambda;        ///< in: where to start; out: impulses (n, t1, t2), N·s
  std::vector<Vec3> delta_velocity, delta_angular_velocity;  ///< out: Δv = A⁻¹ J^T λ by body

  /// J v of contact i for the bodies' velocities plus `delta`s scaled by 0 or 1.
  Vec3 contact_velocity(std::size_t i, bool with_delta) const;
};

}  // namespace impinge
