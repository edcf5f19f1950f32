// Eigen's sparse Cholesky factorization with approximate minimum degree ordering: no library beside Eigen, the same
// bits everywhere, good up to some 10⁴ unknowns.
#include <Eigen/SparseCholesky>
#include <optional>

#include "engine/core/error.hpp"
#include "engine/core/linear_solver.hpp"

namespace impinge {
namespace {

class SimplicialLlt : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override {
    lower_.emplace(pattern);
    llt_.analyzePattern(lower_->matrix());
  }
  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(lower_.has_value());
    if (!a.all_finite()) return status_ = SolveStatus::not_finite;
    lower_->refill(a);
    llt_.factorize(lower_->matrix());
    return status_ = llt_.info() == Eigen::Success ? SolveStatus::ok : SolveStatus::not_positive_definite;
  }
  SolveReport solve(const VecX& b, VecX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    x = llt_.solve(b);
    return {x.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }
  SolveReport solve_many(const MatX& b, MatX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    x = llt_.solve(b);
    return {x.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }

 private:
  std::optional<LowerTriangle> lower_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> llt_;
  SolveStatus status_ = SolveStatus::ok;
};

}  // namespace

Entry<LinearSolver> simplicial_llt_solver() {
  return entry<LinearSolver, SimplicialLlt>("simplicial_llt", "Eigen's sparse Cholesky factorization");
}

}  // namespace impinge
