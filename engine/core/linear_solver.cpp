#include "engine/core/linear_solver.hpp"

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {

Entry<LinearSolver> conjugate_gradient_solver();
Entry<LinearSolver> simplicial_llt_solver();
#ifdef IMPINGE_CHOLMOD
Entry<LinearSolver> cholmod_solver();
#endif

SolveReport LinearSolver::gram(const SparseColumns& b, MatX& w) {
  constexpr Eigen::Index kSlab = 96;  // columns at a time: memory stays in bounds however many there are
  w.resize(b.cols(), b.cols());
  SolveReport worst;
  for (Eigen::Index begin = 0; begin < b.cols(); begin += kSlab) {
    const Eigen::Index count = std::min(kSlab, b.cols() - begin);
    MatX x;
    const SolveReport report = solve_many(MatX(b.middleCols(begin, count)), x);
    worst.iterations = std::max(worst.iterations, report.iterations);
    worst.residual = std::max(worst.residual, report.residual);
    if (report.status != SolveStatus::ok) worst.status = report.status;
    if (x.rows() != b.rows()) return worst;
    w.middleCols(begin, count) = b.transpose() * x;
  }
  w = 0.5 * (w + MatX(w.transpose()));
  return worst;
}

const Registry<LinearSolver>& linear_solvers() {
  static const Registry<LinearSolver> list = {
      conjugate_gradient_solver(),
      simplicial_llt_solver(),
#ifdef IMPINGE_CHOLMOD
      cholmod_solver(),
#endif
  };
  return list;
}

// Measured by tests/bench/fem.cpp (lattice solid of 6 tetrahedra a cell, K + m/Δt², E 1e5, Δt 0.01 s, one thread, ms;
// CG to 1e-8 from zero, the others to rounding):
//   unknowns   CG solve   CHOLMOD factor / solve   Eigen factor / solve
//      882       0.17         3.7 / 0.05               2.9 / 0.11
//    3,630       1.1          27 / 0.32                 79 / 1.1
//    9,450       4.1          99 / 2.4                1021 / 8.3
//   26,460        17         504 / 16                    –
//   56,862        89        2039 / 42                    –
// So CG solves 20 to 60 right-hand sides before a CHOLMOD factorization has paid, and Eigen's never pays for itself
// beyond a thousand unknowns unless it serves hundreds. But a direct solve is exact, which the contact forces of
// constraint anticipation want, and CG's iterations grow with √E: with 24 and more right-hand sides the factorization
// is taken.
std::string_view automatic_linear_solver(int unknowns, int right_hand_sides) {
  constexpr int kFewRightHandSides = 24;
  if (right_hand_sides < kFewRightHandSides) return "conjugate_gradient";
#ifdef IMPINGE_CHOLMOD
  (void)unknowns;
  return "cholmod";
#else
  // beyond this Eigen's factorization takes longer than hundreds of CG solves
  return unknowns <= 12000 ? "simplicial_llt" : "conjugate_gradient";
#endif
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int unknowns, int right_hand_sides) {
  if (name == "automatic") name = automatic_linear_solver(unknowns, right_hand_sides);
  const Entry<LinearSolver>* found = find_entry(linear_solvers(), name);
  IMPINGE_ASSERT(found != nullptr);
  return found->make();
}

}  // namespace impinge
