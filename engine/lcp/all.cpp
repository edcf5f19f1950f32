// The list of LCP and cone solvers: one line each.
#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

Entry<LcpSolver> automatic_solver();
Entry<LcpSolver> projected_gauss_seidel_solver();
Entry<LcpSolver> nonsmooth_nonlinear_conjugate_gradient_solver();
Entry<LcpSolver> accelerated_projected_gradient_solver();
Entry<LcpSolver> semismooth_newton_solver();
Entry<LcpSolver> pivoting_solver();

std::string_view name_of(StopReason reason) {
  constexpr std::string_view kNames[] = {"converged", "stagnated", "iteration cap", "trivial", "refused"};
  return kNames[static_cast<int>(reason)];
}

const Registry<LcpSolver>& lcp_solvers() {
  static const Registry<LcpSolver> list = {
      automatic_solver(),
      projected_gauss_seidel_solver(),
      nonsmooth_nonlinear_conjugate_gradient_solver(),
      accelerated_projected_gradient_solver(),
      semismooth_newton_solver(),
      pivoting_solver(),
  };
  return list;
}

}  // namespace impinge
