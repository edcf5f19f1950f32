// A frozen step solved by any response with any cone solver, and the ruler that all answers are held against: the
// judge's residuals and the distance to the exact solution in A's norm.
#pragma once

#include "engine/frozen/frozen_step.hpp"

namespace impinge {

/// What a response made of all groups of a frozen step.
struct FrozenOutcome {
  std::vector<GroupAnswer> answers;          ///< by group
  int iterations = 0, outer_iterations = 0;  ///< sums over groups
  double ms = 0.0;           ///< of solving: factorizations and W too, but not the analysis of A's pattern
  bool used_solver = false;  ///< the response asked the cone solver for something
  bool converged = true;     ///< what the response says of itself
  /// why it stopped, in its own words: of the first group that did not converge, if any
  std::string stop;
  /// Relative residual before the first and after each iteration, if it was asked for; the largest of the groups. Empty
  /// where the response shows nothing of its iterations.
  std::vector<double> history;
};

/// All answers by the same measure. Relative: against the largest |J v* - bound| of the group.
struct FrozenVerdict {
  double natural_map = 0.0;  ///< m/s, scaled as in lcp/residual.hpp
  double natural_map_relative = 0.0;
  double momentum = 0.0;         ///< |Δv - A⁻¹ J^T λ|, m/s; of deformable bodies |D⁻¹ (A Δv - J^T λ)| by node
  double residual = 0.0;         ///< relative: the larger of both
  double complementarity = 0.0;  ///< max |λ·û|, J
  double cone_violation = 0.0;   ///< N·s
  int worst = -1;                ///< contact of the largest natural map, counted through all groups
  double distance = 0.0;  ///< ‖Δv - Δv_exact‖_A / ‖Δv_exact‖_A; NaN where that isn't finite or not known
};

class FrozenRuler {
 public:
  /// Solves the step to 1e-12 by the reference response, with the first reference solver that gets there, or else with
  /// the one that comes nearest. The step must outlive this.
  explicit FrozenRuler(const FrozenStep& step);

  FrozenVerdict judge(const std::vector<GroupAnswer>& answers) const;
  /// Relative residual of one group, as in FrozenVerdict.
  double residual(std::size_t group, const GroupSystem& solved) const;
  /// Empty for groups that nothing solved: see unsolved().
  const std::vector<GroupAnswer>& exact() const { return exact_; }
  /// Of which group there is no exact solution, and why; "" if of none. Distances are not known then.
  const std::string& unsolved() const { return unsolved_; }
  const std::string& exact_response() const { return exact_response_; }
  const std::string& exact_solver() const { return exact_solver_; }
  /// Why a cone solver can't solve every group of the step; "" if it can.
  std::string applies(const LcpSolver& solver) const;

 private:
  std::string solve_exactly(const Response& response, std::size_t group, const ConeProblem& problem,
                            ThawedGroup& thawed, GroupAnswer& exact) const;
  const std::vector<Mat3>* diagonal(std::size_t group) const;

  const FrozenStep& step_;
  std::vector<GroupAnswer> exact_;
  std::string exact_response_, exact_solver_, unsolved_;
  std::vector<std::vector<Mat3>> w_diagonal_;  // by group and contact; none where W can't be had
  std::vector<double> scale_;                  // m/s, by group
  double exact_norm_ = 0.0;
};

/// Starts each group from the λ that the run started from. `ruler`: if given, the history is taken, which costs time.
FrozenOutcome solve_frozen(const FrozenStep& step, const Response& response, const LcpSolver& solver,
                           const ResponseContext& context, const FrozenRuler* ruler = nullptr);

}  // namespace impinge
