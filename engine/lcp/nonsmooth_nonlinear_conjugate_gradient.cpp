// Nonsmooth nonlinear conjugate gradients, NNCG [SilcowitzHansen10]. Costs a sweep and one more product an iteration.
#include "engine/lcp/conjugate_sweeps.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

class NonsmoothNonlinearConjugateGradient : public LcpSolver {
 public:
  int reference_rank() const override { return 3; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    ConjugateSweeps sweeps(problem);
    for (int k = 1; k <= settings.max_iterations; ++k) {
      const double change = sweeps.sweep(lambda);
      if (stop.solved(lambda, change)) return {k, StopReason::converged};
      if (change == 0.0) return {k, StopReason::stagnated};
    }
    return {settings.max_iterations, StopReason::iteration_cap};
  }
};

}  // namespace

Entry<LcpSolver> nonsmooth_nonlinear_conjugate_gradient_solver() {
  return entry<LcpSolver, NonsmoothNonlinearConjugateGradient>(
      "nonsmooth_nonlinear_conjugate_gradient", "NNCG: Gauss-Seidel sweeps made conjugate by Fletcher-Reeves");
}

}  // namespace impinge
