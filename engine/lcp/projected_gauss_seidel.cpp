// Projected Gauss-Seidel, one 3 x 3 block a contact: each contact in turn is solved exactly (take-off, stick or slip on the
// true cone) with the others held. [Haapaoja16 §4.2], block form [Jean99]. Cost of a sweep: linear in the contacts for a
// factored W. For a tower of two boxes with mass ratio r the error shrinks by r/(1+r) a sweep: slow, not wrong. Sweeps that
// alternate in direction were tried: on that tower they take twice as many, since the contact at the turn is solved twice.
#include <Eigen/QR>
#include <algorithm>

#include "engine/contact/friction_cone.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/lcp/residual.hpp"

namespace impinge {
namespace {

class ProjectedGaussSeidel : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    const std::size_t n = problem.q.size();
    double scale = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      scale = std::max(scale, problem.has_one_row(i) ? std::abs(problem.q[i].x()) : problem.q[i].norm());
    const double tolerance = settings.tolerance * scale;

    LcpResult result;
    Delassus& w = *problem.w;
    w.begin(lambda);
    if (natural_residual(problem, lambda) <= tolerance) return {0, n == 0 ? StopReason::trivial : StopReason::converged};
    while (result.iterations < settings.max_iterations) {
      double change = 0.0;  // m/s: what the largest correction of the sweep did to its own contact
      for (std::size_t k = 0; k < n; ++k) change = std::max(change, relax(problem, k, lambda));
      ++result.iterations;
      // a small step is not a small residual: the natural map decides, and is only computed when it may hold
      if (change <= 2.0 * tolerance && natural_residual(problem, lambda) <= tolerance) {
        result.reason = StopReason::converged;
        return result;
      }
    }
    result.reason = StopReason::iteration_cap;
    return result;
  }

 private:
  static double relax(const ConeProblem& problem, std::size_t i, std::vector<Vec3>& lambda) {
    Delassus& w = *problem.w;
    const double mu = problem.mu[i];
    const RowKind kind = problem.kind_of(i);
    const bool normal_only = problem.has_one_row(i);
    const Mat3& w_ii = w.diagonal(i);
    const Vec3 u = w.row(i, normal_only) + problem.q[i];
    Vec3 next;
    if (kind == RowKind::attachment) {
      next = lambda[i] - Vec3(w_ii.completeOrthogonalDecomposition().solve(u));
    } else if (kind == RowKind::sliding) {
      next = {lambda[i].x() - u.x() / w_ii(0, 0), 0.0, 0.0};
    } else if (normal_only) {
      next = {std::max(0.0, lambda[i].x() - u.x() / w_ii(0, 0)), 0.0, 0.0};
    } else {
      next = solve_one_contact(w_ii, u - w_ii * lambda[i], mu);
    }
    const Vec3 delta = next - lambda[i];
    if (delta.isZero(0.0)) return 0.0;
    lambda[i] = next;
    w.change(i, delta, normal_only);
    return normal_only ? std::abs(w_ii(0, 0) * delta.x()) : (w_ii * delta).norm();
  }

  static double natural_residual(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
    double worst = 0.0;
    for (std::size_t i = 0; i < problem.q.size(); ++i) {
      const Vec3 u = problem.w->row(i, problem.has_one_row(i)) + problem.q[i];
      worst = std::max(worst, natural_map(problem.kind_of(i), problem.w->diagonal(i), u, lambda[i], problem.mu[i]));
    }
    return worst;
  }
};

}  // namespace

Entry<LcpSolver> projected_gauss_seidel_solver() {
  return entry<LcpSolver, ProjectedGaussSeidel>("projected_gauss_seidel", "block Gauss-Seidel, each contact exact on the true Coulomb cone");
}

}  // namespace impinge
