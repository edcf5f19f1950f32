// The list of LCP and cone solvers: one line each.
#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

Entry<LcpSolver> projected_gauss_seidel_solver();

const Registry<LcpSolver>& lcp_solvers() {
  static const Registry<LcpSolver> list = {projected_gauss_seidel_solver()};
  return list;
}

}  // namespace impinge
