// CHOLMOD's supernodal Cholesky factorization: dense kernels on blocks of columns, several times faster than a
// simplicial one from a few thousand unknowns on. Compiled in only where the library was found (cmake defines
// IMPINGE_CHOLMOD). Its supernodal part is under GPL-2+, so a program with it is under the GPL too; without it
// everything works, slower.
#ifdef IMPINGE_CHOLMOD

#include <Eigen/CholmodSupport>
#include <optional>

#include "engine/core/error.hpp"
#include "engine/core/linear_solver.hpp"

namespace impinge {
namespace {

class Cholmod : public LinearSolver {
 public:
  Cholmod() { llt_.cholmod().print = 0; }
  void analyze(const BlockPattern& pattern) override {
    lower_.emplace(pattern);
    llt_.analyzePattern(lower_->matrix());
  }
  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(lower_.has_value());
    // CHOLMOD reports success on NaN and then answers NaN
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
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> llt_;
  SolveStatus status_ = SolveStatus::ok;
};

}  // namespace

Entry<LinearSolver> cholmod_solver() {
  return entry<LinearSolver, Cholmod>("cholmod", "CHOLMOD's supernodal Cholesky factorization");
}

}  // namespace impinge

#endif
