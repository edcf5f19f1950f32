// Springs at contacts, implicit in A: the convex minimum of ½‖Δv‖²_A plus the springs' potential, by Newton's method
// with a search along the line. What the penalty response and the answer to contradicting contacts share.
#pragma once

#include "engine/response/spring_solver.hpp"

namespace impinge {

/// The forces of one contact as impulses over the sub-step, by its relative velocity u.
struct SpringLaw {
  RowKind kind = RowKind::contact;
  double slope = 0.0;                       ///< -dλ_n/du, N·s/(m/s)
  double offset = 0.0;                      ///< λ_n at u = 0, N·s
  double friction = 0.0, slip_speed = 1.0;  ///< mu; ε in m/s

  double normal(const Vec3& u) const;
  /// f(|u_t|/ε) = 2 y - y² up to y = 1 and 1 beyond it: what one unit of normal impulse makes of tangential resistance.
  double resistance(double speed) const;
  /// λ at u, with the friction of a normal impulse n.
  Vec3 impulse(const Vec3& u, double n) const;
  /// -dλ/du with n kept: symmetric, positive semidefinite.
  Mat3 stiffness(const Vec3& u, double n) const;
  /// -dλ/du with the friction of the normal impulse at u: not symmetric.
  Mat3 derivative(const Vec3& u) const;
};

struct SpringsResult {
  int iterations = 0;
  bool converged = false;
};

/// Fills group.lambda with the impulses of the velocities that they leave; a, linear: of this group. Friction goes by the
/// normal impulse of the iterate, so it is that of the answer at convergence: A Δv - J^T λ of `tolerance` times what
/// the forces change.
SpringsResult solve_springs(const GroupOperator& a, const std::vector<SpringLaw>& law, double tolerance,
                            int max_iterations, GroupSystem& group, SpringSolver& linear);

/// Δv = A⁻¹ J^T λ of group.lambda as it stands. False if conjugate gradients, where they are asked, didn't get there.
bool apply_springs(const GroupOperator& a, GroupSystem& group, const SpringSolver& linear);

}  // namespace impinge
