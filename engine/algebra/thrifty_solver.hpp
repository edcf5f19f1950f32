// One right-hand side, and two solvers for it.
#pragma once

#include "engine/algebra/linear_solver.hpp"

namespace impinge {

/// The iterations of conjugate gradients on A that take as long as its factorization by `direct`, which has been analyzed;
/// 0: it doesn't factorize.
double iterations_of_factor(const LinearSolver& direct, const BlockPattern& pattern);
/// And as long as so many operations on dense blocks.
double iterations_of_work(double operations, const BlockPattern& pattern);
/// The iterations that A takes at least, as a rule.
double iterations_at_least(const BlockMatrix& a);

/// Conjugate gradients as long as they cost less than a factorization, and from then on the factorization. Operations are
/// counted, never time, and nothing is kept from one system to the next: the same system takes the same way everywhere.
class ThriftySolver : public LinearSolver {
 public:
  /// Both analyzed with the same pattern; they outlive this. What `direct` factorizes stays with it for who asks next.
  ThriftySolver(LinearSolver& iterative, LinearSolver& direct) : iterative_(iterative), direct_(direct) {}

  void analyze(const BlockPattern&) override {}
  SolveStatus factorize(const BlockMatrix& a) override;
  SolveReport solve(const VecX& b, VecX& x) override;
  SolveReport solve_many(const MatX& b, MatX& x) override;

 private:
  /// Where there is nothing to weigh.
  LinearSolver& chosen() const;

  LinearSolver &iterative_, &direct_;
  const BlockMatrix* a_ = nullptr;
  int worth_ = 0;  // iterations that cost as much as a factorization; 0: nothing to weigh
};

}  // namespace impinge
