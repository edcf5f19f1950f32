// Nonsmooth nonlinear conjugate gradients, NNCG [SilcowitzHansen10]: a Gauss-Seidel sweep is taken for a descent step
// (minus the gradient), and steps are made conjugate by Fletcher and Reeves' rule. Costs a sweep and one more product
// an iteration.
//
// The momentum may carry λ out of its cones; the sweep that follows brings it back, so only what a sweep left is handed
// out. Where the sweeps' steps grow the direction is dropped: then the method is Gauss-Seidel.
#include <algorithm>
#include <limits>

#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

class NonsmoothNonlinearConjugateGradient : public LcpSolver {
 public:
  int reference_rank() const override { return 3; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    const std::size_t n = lambda.size();
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    std::vector<Vec3> before, direction(n, Vec3::Zero()), step(n);
    double size_before = std::numeric_limits<double>::infinity();  // so that the first step is taken as it is
    for (int sweep = 1; sweep <= settings.max_iterations; ++sweep) {
      before = lambda;
      const double change = gauss_seidel_sweep(problem, lambda);
      if (stop.solved(lambda, change)) return {sweep, StopReason::converged};
      if (change == 0.0) return {sweep, StopReason::stagnated};
      if (sweep == settings.max_iterations) break;
      double size = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        step[i] = lambda[i] - before[i];
        size += step[i].dot(problem.w->diagonal(i) * step[i]);  // an energy: units of contacts with unlike masses agree
      }
      const double beta = size / size_before;
      size_before = size;
      if (beta > 1.0) {
        std::fill(direction.begin(), direction.end(), Vec3::Zero());
        continue;
      }
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3 momentum = beta * direction[i];
        direction[i] = momentum + step[i];
        if (momentum.isZero(0.0)) continue;
        lambda[i] += momentum;
        problem.w->change(i, momentum, problem.has_one_row(i));
      }
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
