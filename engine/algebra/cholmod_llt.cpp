// Supernodal Cholesky factorization: dense kernels on blocks of columns, several times faster than a simplicial one from a
// few thousand unknowns on. CHOLMOD finds the order of the unknowns and the supernodes; the numbers are our own (its own
// ask a BLAS, whose bits depend on the processor, and Debian's has no lock for more threads than one). Compiled in only
// where the library was found (cmake defines IMPINGE_CHOLMOD). Its supernodal part is under GPL-2+, so a program with it
// is under the GPL too; without it everything works, slower.
#ifdef IMPINGE_CHOLMOD

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <mutex>
#include <optional>

#include "engine/algebra/supernodal_gram.hpp"
#include "engine/core/apart.hpp"
#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"

namespace impinge {
namespace {

/// CHOLMOD's analysis of a pattern.
class Analysis : Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
 public:
  explicit Analysis(const Eigen::SparseMatrix<double>& lower) {
    static std::mutex one;  // METIS below it keeps what it works with in one place
    const std::lock_guard<std::mutex> alone(one);
    cholmod().print = 0;
    analyzePattern(lower);
  }
  double operations() { return cholmod().fl; }
  Supernodes supernodes() const {
    const cholmod_factor& l = *m_cholmodFactor;
    const auto copy = [](const void* from, std::size_t count) {
      const int* first = static_cast<const int*>(from);
      return std::vector<int>(first, first + count);
    };
    return {copy(l.super, l.nsuper + 1), copy(l.pi, l.nsuper + 1), copy(l.s, l.ssize), copy(l.Perm, l.n)};
  }
};

class Cholmod : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override {
    lower_.emplace(pattern);
    factor_.reset();
    run_apart([&] {
      Analysis analysis(lower_->matrix());
      work_ = analysis.operations();
      nodes_.emplace(analysis.supernodes());
    });
    factored_ = false;
  }
  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(lower_.has_value());
    if (!a.all_finite()) {
      factored_ = false;
      return status_ = SolveStatus::not_finite;
    }
    if (!lower_->refill(a) && factored_) return status_;
    if (!factor_) take_memory();
    factored_ = false;  // until it is
    status_ = factor_->factorize(lower_->matrix()) ? SolveStatus::ok : SolveStatus::not_positive_definite;
    factored_ = true;
    ++factorizations;
    return status_;
  }
  SolveReport solve(const VecX& b, VecX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    factor_->solve(b, x);
    return report_on(x);
  }
  SolveReport solve_many(const MatX& b, MatX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    factor_->solve(b, x);
    return report_on(x);
  }
  SolveReport gram(const SparseColumns& b, MatX& w) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    supernodal_gram(*factor_, b, w);
    return report_on(w);
  }

  double factor_work() const override { return work_; }

 private:
  /// What the analysis has found is taken with the first factorization.
  void take_memory() {
    const double numbers = static_cast<double>(nodes_->values(nodes_->count()) + nodes_->waiting());
    check_memory("", fmt::format("the factorization of a system of {} unknowns", lower_->matrix().rows()),
                 8.0 * numbers, "use fewer elements, or simulation.linear_solver = \"conjugate_gradient\"");
    factor_.emplace(std::move(*nodes_), lower_->matrix());
  }
  static SolveReport report_on(const MatX& x) {
    return {x.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }

  std::optional<LowerTriangle> lower_;
  std::optional<Supernodes> nodes_;  // until the factor has them
  std::optional<SupernodalFactor> factor_;
  SolveStatus status_ = SolveStatus::ok;
  double work_ = 0.0;
  bool factored_ = false;
};

}  // namespace

Entry<LinearSolver> cholmod_llt_solver() {
  return entry<LinearSolver, Cholmod>("cholmod", "supernodal Cholesky factorization, ordered by CHOLMOD");
}

}  // namespace impinge

#endif
