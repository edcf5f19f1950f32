// CHOLMOD's supernodal Cholesky factorization: dense kernels on blocks of columns, several times faster than a
// simplicial one from a few thousand unknowns on. Compiled in only where the library was found (cmake defines
// IMPINGE_CHOLMOD). Its supernodal part is under GPL-2+, so a program with it is under the GPL too; without it
// everything works, slower.
#ifdef IMPINGE_CHOLMOD

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <mutex>
#include <optional>

#include "engine/algebra/serial_openmp.hpp"
#include "engine/algebra/supernodal_gram.hpp"
#include "engine/core/apart.hpp"
#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"

namespace impinge {
namespace {

/// One thread at a time calls CHOLMOD, and it uses that thread alone: Debian's serial OpenBLAS below it hands out its
/// working memory without a lock, and two factorizations at a time spoil each other.
class Turn {
  static std::mutex& in_use() {
    static std::mutex mutex;
    return mutex;
  }
  const std::lock_guard<std::mutex> alone_{in_use()};
  const SerialOpenMp serial_;
};

class Cholmod : public LinearSolver {
 public:
  Cholmod() { llt_.cholmod().print = 0; }
  void analyze(const BlockPattern& pattern) override {
    lower_.emplace(pattern);
    in_turn([&] {
      llt_.analyzePattern(lower_->matrix());
      work_ = llt_.cholmod().fl;
    });
    factored_ = is_taken_ = false;
  }
  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(lower_.has_value());
    // CHOLMOD reports success on NaN and then answers NaN
    if (!a.all_finite()) {
      factored_ = false;
      return status_ = SolveStatus::not_finite;
    }
    if (!lower_->refill(a) && factored_) return status_;
    // what the analysis has found is taken with the first factorization
    if (!is_taken_)
      check_memory("", fmt::format("the factorization of a system of {} unknowns", lower_->matrix().rows()),
                   8.0 * static_cast<double>(llt_.factor().xsize),
                   "use fewer elements, or simulation.linear_solver = \"conjugate_gradient\"");
    is_taken_ = true;
    in_turn([&] { llt_.factorize(lower_->matrix()); });
    factored_ = true;
    ++factorizations;
    return status_ = llt_.info() == Eigen::Success ? SolveStatus::ok : SolveStatus::not_positive_definite;
  }
  SolveReport solve(const VecX& b, VecX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    const Turn turn;
    x = llt_.solve(b);
    return {x.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }
  SolveReport solve_many(const MatX& b, MatX& x) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    in_turn([&] { x = llt_.solve(b); });
    return {x.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }
  SolveReport gram(const SparseColumns& b, MatX& w) override {
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    in_turn([&] { supernodal_gram(llt_.factor(), b, w); });
    return {w.allFinite() ? SolveStatus::ok : SolveStatus::not_finite, 0, 0.0};
  }

  double factor_work() const override { return work_; }

 private:
  /// What takes long; whoever wants to pause meanwhile may.
  template <typename Work>
  static void in_turn(Work&& work) {
    run_apart([&] {
      const Turn turn;
      work();
    });
  }

  /// Eigen's wrapper, with a look at the factor itself.
  struct Factorization : Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
    const cholmod_factor& factor() const { return *m_cholmodFactor; }
  };

  std::optional<LowerTriangle> lower_;
  Factorization llt_;
  SolveStatus status_ = SolveStatus::ok;
  double work_ = 0.0;
  bool factored_ = false, is_taken_ = false;  // is_taken_: the factor's numbers have their place
};

}  // namespace

Entry<LinearSolver> cholmod_llt_solver() {
  return entry<LinearSolver, Cholmod>("cholmod", "CHOLMOD's supernodal Cholesky factorization");
}

}  // namespace impinge

#endif
