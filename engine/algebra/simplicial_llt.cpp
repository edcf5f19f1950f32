// Eigen's sparse Cholesky factorization with approximate minimum degree ordering: no library beside Eigen, the same
// bits everywhere, good up to some 10⁴ unknowns.
#include <Eigen/SparseCholesky>
#include <optional>

#include "engine/algebra/linear_solver.hpp"
#include "engine/core/apart.hpp"
#include "engine/core/error.hpp"

namespace impinge {
namespace {

class SimplicialLlt : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override {
    lower_.emplace(pattern);
    run_apart([&] { llt_.analyzePattern(lower_->matrix()); });
    factored_ = false;
  }
  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(lower_.has_value());
    if (!a.all_finite()) {
      factored_ = false;
      return status_ = SolveStatus::not_finite;
    }
    if (!lower_->refill(a) && factored_) return status_;
    run_apart([&] { llt_.factorize(lower_->matrix()); });
    factored_ = true;
    ++factorizations;
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
  /// Y = L⁻¹ P B takes as much memory as B would as a dense matrix.
  SolveReport gram(const SparseColumns& b, MatX& w) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    w.setZero(b.cols(), b.cols());
    if (w.size() == 0) return {status_, 0, 0.0};  // Eigen's product would bind a reference to what isn't there
    MatX y = llt_.permutationP() * MatX(b);
    llt_.matrixL().solveInPlace(y);
    w.selfadjointView<Eigen::Lower>().rankUpdate(y.transpose());
    w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
    return {w.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }

 private:
  std::optional<LowerTriangle> lower_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> llt_;
  SolveStatus status_ = SolveStatus::ok;
  bool factored_ = false;
};

}  // namespace

Entry<LinearSolver> simplicial_llt_solver() {
  return entry<LinearSolver, SimplicialLlt>("simplicial_llt", "Eigen's sparse Cholesky factorization");
}

}  // namespace impinge
