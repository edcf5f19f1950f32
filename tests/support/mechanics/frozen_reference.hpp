// Second ways to what a frozen step's methods compute: the frictionless answer from one system of all unknowns, and W
// by other routes.
#pragma once

#include "engine/frozen/frozen_step.hpp"

namespace impinge::test {

/// A step of one group, as if a run had been stopped there. Its answer is empty.
FrozenStep frozen_of(const GroupSystem& group);
/// The same with every contact frictionless, started from λ = 0.
FrozenStep without_friction(FrozenStep step);

/// Δv and λ of the frictionless problem (contacts only) from the monolithic KKT system: primal-dual interior point
/// steps on [A -J^T; J S/Λ] in Δv and λ at once, one sparse LDL^T each. Neither W nor A⁻¹ is formed.
GroupAnswer kkt_answer(const FrozenGroup& group);

/// W = J A⁻¹ J^T.
/// as constraint anticipation does: half solves
MatX w_assembled(const FrozenGroup& group, const LinearSolverChoice& linear_solver);
/// J (A⁻¹ J^T), not made symmetric
MatX w_by_whole_solves(const FrozenGroup& group, const LinearSolverChoice& linear_solver);
MatX w_by_dense_inverse(const FrozenGroup& group);  ///< A⁻¹ written out, body by body

}  // namespace impinge::test
