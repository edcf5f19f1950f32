#include "engine/algebra/linear_solver.hpp"

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {

namespace {
constexpr std::string_view kAutomatic = "automatic";
}

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
  static const Registry<LinearSolver> list = [] {
    Registry<LinearSolver> all;
    IMPINGE_LIST(all, conjugate_gradient_solver);
    IMPINGE_LIST(all, simplicial_llt_solver);
#ifdef IMPINGE_CHOLMOD
    IMPINGE_LIST(all, cholmod_llt_solver);
#endif
    return all;
  }();
  return list;
}

// Measured by tests/bench/linear_solvers.cpp (lattice solid of 6 tetrahedra a cell, K + m/Δt², Δt 0.01 s, one thread,
// ms; CG to 1e-8 from zero at E 1e5, the others to rounding; W of 100 contacts side by side: by half solves, and by
// whole ones):
//   unknowns   CG solve   supernodal factor / solve / W (whole)   Eigen factor / solve / W (whole)
//      882       0.31          1 / 0.07 /   –                           3.7 / 0.14 /   –
//    3,630       2.2          19 / 0.71 /  23 (194)                      135 / 1.4 / 122 (333)
//    9,450       5.3          74 / 3.8  /  25 (576)                     1860 / 10  / 594 (2342)
//   26,460        34         840 / 23   / 126 (2365)                       –
//   56,862       138        3560 / 55   / 297 (5736)                       –
// At E 1e7 CG takes six times as long. So CG solves 3 to 26 right-hand sides of soft bodies before a supernodal
// factorization has paid, and Eigen's pays beyond a few thousand unknowns only where it serves hundreds. But a direct
// solve is exact, which the contact forces of constraint anticipation want, W then costs as much as the factorization
// again or, with large bodies, a tenth of it, and CG's iterations grow with √E: with 24 and more right-hand sides the
// factorization is taken.
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

LinearSolverChoice& LinearSolverChoice::operator=(std::string_view name) {
  chosen_ = name == kAutomatic ? nullptr : find_entry(linear_solvers(), name);
  if (chosen_ == nullptr && name != kAutomatic)
    throw InternalError("no linear solver is named '" + std::string(name) + "'");
  return *this;
}

std::string_view LinearSolverChoice::name() const { return is_automatic() ? kAutomatic : chosen_->name; }

std::vector<std::string> LinearSolverChoice::names() const {
  std::vector<std::string> names = {std::string(kAutomatic)};
  for (const Entry<LinearSolver>& entry : linear_solvers()) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<LinearSolver> LinearSolverChoice::make(int unknowns, int right_hand_sides) const {
  if (!is_automatic()) return chosen_->make();
  return make_named(linear_solvers(), automatic_linear_solver(unknowns, right_hand_sides));
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int unknowns, int right_hand_sides) {
  return LinearSolverChoice(name).make(unknowns, right_hand_sides);
}

}  // namespace impinge
