// One seam for solving A x = b with a symmetric positive definite A of 3 × 3 blocks: the pattern is analyzed once,
// numbers are taken when A changed, then any number of right-hand sides follow.
#pragma once

#include "engine/algebra/block_matrix.hpp"
#include "engine/core/registry.hpp"

namespace impinge {

enum class SolveStatus {
  ok,
  not_positive_definite,  ///< a negative pivot or curvature was met; x is not a solution
  not_converged,          ///< the iteration cap was hit; x is the last iterate
  not_finite              ///< A or b holds NaN or infinity
};

struct SolveReport {
  SolveStatus status = SolveStatus::ok;
  int iterations = 0;     ///< 0 for a direct solver
  double residual = 0.0;  ///< ‖b − A x‖/‖b‖ as the iteration knows it; 0 for a direct solver
};

/// Few entries a column, in compressed columns.
using SparseColumns = Eigen::SparseMatrix<double>;

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Whatever depends on the pattern only. Must come before factorize, and again when the pattern changes.
  virtual void analyze(const BlockPattern& pattern) = 0;
  /// Takes the numbers of A, whose lifetime must span the solves that follow. A factorization is made only if they
  /// differ from the last ones.
  virtual SolveStatus factorize(const BlockMatrix& a) = 0;
  /// x = A⁻¹ b. What x holds on entry (if it has b's size) starts an iterative solver.
  virtual SolveReport solve(const VecX& b, VecX& x) = 0;
  /// X = A⁻¹ B, column by column or at once; X gets B's size. The worst column's report.
  virtual SolveReport solve_many(const MatX& b, MatX& x) = 0;
  /// W = Bᵀ A⁻¹ B, exactly symmetric, for sparse columns (contacts: a few nodes each). A factorization needs half of a
  /// solve for each, and only where a column reaches; other solvers go by solve_many.
  virtual SolveReport gram(const SparseColumns& b, MatX& w);
  /// Floating-point operations of one factorization, known once it is analyzed; 0 where there is none, or nobody tells.
  virtual double factor_work() const { return 0.0; }

  /// ‖b − A x‖ <= tolerance ‖b‖ ends an iteration.
  double tolerance = 1e-8;
  int max_iterations = 10000;
  int factorizations = 0;  ///< numeric ones made so far; 0 for an iterative solver
};

/// `conjugate_gradient`, `simplicial_llt` and, where it was compiled in, `cholmod`.
const Registry<LinearSolver>& linear_solvers();

/// The registered name that is best for `unknowns` unknowns and `right_hand_sides` solves with each A; see
/// linear_solver.cpp for the measurements behind it.
std::string_view automatic_linear_solver(int unknowns, int right_hand_sides);

/// What a body that may be in contact asks its solver for at a time: three a contact.
inline constexpr int kContactRightHandSides = 100;

/// Which solver systems get: a registered one, or by their size whichever is best.
class LinearSolverChoice {
 public:
  LinearSolverChoice() = default;  ///< by size: "automatic"
  explicit LinearSolverChoice(std::string_view name) { *this = name; }
  /// A registered name or "automatic"; throws InternalError for another.
  LinearSolverChoice& operator=(std::string_view name);
  bool operator==(const LinearSolverChoice&) const = default;

  bool is_automatic() const { return chosen_ == nullptr; }
  std::string_view name() const;
  std::vector<std::string> names() const;  ///< all that there are
  std::unique_ptr<LinearSolver> make(int unknowns, int right_hand_sides) const;

 private:
  const Entry<LinearSolver>* chosen_ = nullptr;
};

/// A solver by the name of a choice.
std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int unknowns = 0, int right_hand_sides = 1);

}  // namespace impinge
