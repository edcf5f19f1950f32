// Projected Gauss-Seidel, one 3 x 3 block a contact: each contact in turn is solved exactly (take-off, stick or slip on
// the true cone) with the others held. [Haapaoja16 §4.2], block form [Jean99]. Cost of a sweep: linear in the contacts
// for a factored W. For a tower of two boxes with mass ratio r the error shrinks by r/(1+r) a sweep: slow, not wrong.
// Sweeps that alternate in direction were tried: on that tower they take twice as many, since the contact at the turn
// is solved twice.
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

class ProjectedGaussSeidel : public LcpSolver {
 public:
  int reference_rank() const override { return 4; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    for (int sweep = 1; sweep <= settings.max_iterations; ++sweep) {
      const double change = gauss_seidel_sweep(problem, lambda);
      if (stop.solved(lambda, change)) return {sweep, StopReason::converged};
      // each contact is solved to the last bit: so is every later sweep
      if (change == 0.0) return {sweep, StopReason::stagnated};
    }
    return {settings.max_iterations, StopReason::iteration_cap};
  }
};

}  // namespace

Entry<LcpSolver> projected_gauss_seidel_solver() {
  return entry<LcpSolver, ProjectedGaussSeidel>("projected_gauss_seidel",
                                                "block Gauss-Seidel, each contact exact on the true Coulomb cone");
}

}  // namespace impinge
