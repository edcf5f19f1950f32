// The list of LCP and cone solvers: one line each. The first is the default.
#include <algorithm>

#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

std::string_view name_of(StopReason reason) {
  constexpr std::string_view kNames[] = {"converged", "stagnated", "iteration cap",
                                         "trivial",   "refused",   "contradiction"};
  return kNames[static_cast<int>(reason)];
}

const Registry<LcpSolver>& lcp_solvers() {
  static const Registry<LcpSolver> list = [] {
    Registry<LcpSolver> all;
    IMPINGE_LIST(all, automatic_solver);
    IMPINGE_LIST(all, projected_gauss_seidel_solver);
    IMPINGE_LIST(all, nonsmooth_nonlinear_conjugate_gradient_solver);
    IMPINGE_LIST(all, accelerated_projected_gradient_solver);
    IMPINGE_LIST(all, semismooth_newton_solver);
    IMPINGE_LIST(all, smoothing_newton_solver);
    IMPINGE_LIST(all, dual_active_set_solver);
    IMPINGE_LIST(all, pivoting_solver);
    return all;
  }();
  return list;
}

std::vector<const Entry<LcpSolver>*> reference_solvers() {
  std::vector<std::pair<int, const Entry<LcpSolver>*>> ranked;
  for (const Entry<LcpSolver>& entry : lcp_solvers())
    if (const int rank = entry.make()->reference_rank(); rank > 0) ranked.emplace_back(rank, &entry);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
  std::vector<const Entry<LcpSolver>*> entries;
  entries.reserve(ranked.size());
  for (const auto& [rank, entry] : ranked) entries.push_back(entry);
  return entries;
}

}  // namespace impinge
