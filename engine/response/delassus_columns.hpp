// Few contacts on a stiff body: W = J A⁻¹ J^T column by column, each by conjugate gradients.
#pragma once

#include "engine/lcp/lcp_solver.hpp"
#include "engine/response/operators/group_operator.hpp"

namespace impinge {

struct DelassusColumnsResult {
  int solves = 0, iterations = 0;
  bool converged = false;
};

/// Rows up to which the columns take less time than the augmented Lagrangian.
constexpr std::size_t kFewRows = 60;

/// From where `x` (Δv, as GroupOperator holds it) and group.lambda stand. problem: q, mu and kinds of the group's
/// contacts; `solver` gets it with a dense W. `tolerance`, m/s: of the natural map of every contact, and of D⁻¹ (A Δv -
/// J^T λ) of every node and rigid body. What does not converge leaves x and λ as they came.
DelassusColumnsResult solve_by_delassus_columns(const GroupOperator& a, ConeProblem problem, const LcpSolver& solver,
                                                double tolerance, GroupSystem& group, VecX& x);

}  // namespace impinge
