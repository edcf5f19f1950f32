// The augmented Lagrangian method on contact with friction, in velocities: what is left where sweeps over the contacts
// stall.
#pragma once

#include "engine/lcp/cone_problem.hpp"
#include "engine/response/operators/group_operator.hpp"

namespace impinge {

struct AugmentedLagrangianResult {
  int newton_steps = 0, multiplier_steps = 0;
  bool converged = false;
};

/// From where `x` (Δv, as GroupOperator holds it) and group.lambda stand; improves both. problem: q, mu and kinds of
/// the group's contacts. `tolerance`, m/s: of the natural map of every contact, and of D⁻¹ (A Δv - J^T λ) of every node
/// and rigid body.
AugmentedLagrangianResult solve_by_augmented_lagrangian(const GroupOperator& a, const ConeProblem& problem,
                                                        double tolerance, GroupSystem& group, VecX& x);

}  // namespace impinge
