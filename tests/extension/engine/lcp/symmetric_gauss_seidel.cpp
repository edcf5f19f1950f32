// Projected Gauss-Seidel whose sweeps go forth and back.
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

class SymmetricGaussSeidel : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    for (int sweep = 1; sweep <= settings.max_iterations; ++sweep) {
      double change = 0.0;
      for (std::size_t k = 0; k < lambda.size(); ++k)
        change = std::max(change, relax_contact(problem, sweep % 2 == 1 ? k : lambda.size() - 1 - k, lambda));
      if (stop.solved(lambda, change)) return {sweep, StopReason::converged};
      if (change == 0.0) return {sweep, StopReason::stagnated};
    }
    return {settings.max_iterations, StopReason::iteration_cap};
  }
};

}  // namespace

Entry<LcpSolver> symmetric_gauss_seidel_solver() {
  return entry<LcpSolver, SymmetricGaussSeidel>("symmetric_gauss_seidel", "Gauss-Seidel, forth and back in turn");
}

}  // namespace impinge
