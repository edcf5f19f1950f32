// Sweeps where they are quick, Newton where they are not. Gauss-Seidel begins, from the last sub-step's λ; once its
// rate is known, what it still needs is compared with the price of Newton's factorizations. Counts decide, never
// clocks, so the same problem takes the same way everywhere.
//
// Price in sweeps: some 15 factorizations of 2/3 (3n)³ operations at full speed against 18 n² a sweep at a fraction of
// it, about 6 n, and less since open contacts leave the factorization; 2 n was the best of 6, 2 and 0.5 on stacks,
// piles and deformable cubes. With more contacts than kMostDense (a W with factors, whose sweeps cost n: kMostFactored)
// the sweeps are made conjugate instead. Gauss-Seidel and then two short tries of Newton from either end were no
// better. Where all bodies are rigid alternating directions come before either sweeps: what they don't solve in three
// quarters of the iterations goes on from their best.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/lcp/alternating_directions.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {

Entry<LcpSolver> nonsmooth_nonlinear_conjugate_gradient_solver();
Entry<LcpSolver> semismooth_newton_solver();

namespace {

constexpr int kFirstSweeps = 30;  // before the rate is looked at
constexpr int kWindow = 10;       // of them that it is taken over
constexpr std::size_t kMostDense = 1500, kMostFactored = 300;
constexpr double kSweepsPerContact = 2.0;    // the price of Newton's method
constexpr double kSweepsOfConjugate = 50.0;  // what conjugate sweeps cost beside what they save

class Automatic : public LcpSolver {
 public:
  bool chooses_by_problem() const override { return true; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    const std::size_t n = lambda.size();
    const bool newton = n <= (problem.w->has_factors() ? kMostFactored : kMostDense);
    const double price = newton ? kSweepsPerContact * static_cast<double>(n) : kSweepsOfConjugate;
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    if (!newton && can_alternate_directions(problem)) return solve_together(problem, settings, lambda);
    const double goal = settings.tolerance * velocity_scale(problem);
    std::vector<double> changes;
    for (int sweep = 1; sweep <= settings.max_iterations; ++sweep) {
      const double change = gauss_seidel_sweep(problem, lambda);
      if (stop.solved(lambda, change)) return {sweep, StopReason::converged};
      if (change == 0.0) return {sweep, StopReason::stagnated};
      changes.push_back(change);
      if (sweep < kFirstSweeps || sweep == settings.max_iterations) continue;
      if (sweeps_left(changes, goal) > std::min(price, static_cast<double>(settings.max_iterations - sweep)))
        return go_on(newton ? semismooth_newton_solver() : nonsmooth_nonlinear_conjugate_gradient_solver(), problem,
                     settings, sweep, lambda);
    }
    return {settings.max_iterations, StopReason::iteration_cap};
  }

 private:
  /// What the rate of the last sweeps says.
  static double sweeps_left(const std::vector<double>& changes, double goal) {
    const double now = changes.back(), rate = std::pow(now / changes[changes.size() - 1 - kWindow], 1.0 / kWindow);
    if (now <= goal) return 0.0;
    return rate < 1.0 ? std::log(goal / now) / std::log(rate) : std::numeric_limits<double>::infinity();
  }

  /// Many contacts of rigid bodies. Sweeps don't begin here: forces that hold each other in balance, which they bring
  /// in, leave a method of all bodies slowly.
  static LcpResult solve_together(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) {
    LcpSettings part = settings;
    part.max_iterations = settings.max_iterations - settings.max_iterations / 4;
    if (settings.history != nullptr) settings.history->pop_back();  // it begins with the same residual
    const LcpResult result = alternate_directions(problem, part, lambda);
    if (result.solved()) return result;
    return go_on(nonsmooth_nonlinear_conjugate_gradient_solver(), problem, settings, result.iterations, lambda);
  }

  static LcpResult go_on(const Entry<LcpSolver>& with, const ConeProblem& problem, LcpSettings settings, int sweeps,
                         std::vector<Vec3>& lambda) {
    const std::vector<Vec3> before = lambda;
    settings.max_iterations -= sweeps;
    if (settings.history != nullptr) settings.history->pop_back();  // the next one begins with the same residual
    LcpResult result = with.make()->solve(problem, settings, lambda);
    if (!result.solved() && !(judge(problem, lambda).map.relative < judge(problem, before).map.relative))
      lambda = before;
    result.iterations += sweeps;
    return result;
  }
};

}  // namespace

Entry<LcpSolver> automatic_solver() {
  return entry<LcpSolver, Automatic>(
      "automatic", "Gauss-Seidel, and where it is slow semismooth Newton (many contacts: ADMM, NNCG)");
}

}  // namespace impinge
