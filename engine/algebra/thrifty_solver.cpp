// Measured on cubes of lattice cells with 300 to 26,460 unknowns (one thread): a factorization takes the time of
// 30 + 0.33 r iterations, r its floating-point operations over an iteration's, within a fifth. With s = √(D/m), D a node's
// diagonal block of A and m the mass that its row sums up to, conjugate gradients took 5 to 12 s iterations to 1e-8 where
// bodies are soft (s < 60, h = 8 and 10 ms), 4 s where they are stiff.
//
// A muscle's strand, of 1e6 Pa: 466 iterations, 14 ms, or a factorization, 3 ms. Dragons of 1e4, 1e5, 1e6, 1e7 Pa: 66,
// 263, 591, 1,303 iterations, 2 to 40 ms, or 3 ms.
#include "engine/algebra/thrifty_solver.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

constexpr double kBesideWork = 30.0, kOfWork = 0.33;  // iterations a factorization
constexpr double kIterations = 5.0;                   // the least of √(D/m)

double iteration_work(const BlockPattern& p) { return 18.0 * p.blocks() + 36.0 * 3.0 * p.rows; }

/// √(D/m) of the middle node; beside held ones the rows sum up to more than the mass.
double stiffness_ratio(const BlockMatrix& a) {
  const BlockPattern& p = *a.pattern;
  std::vector<double> ratio(static_cast<std::size_t>(p.rows));
  for (int i = 0; i < p.rows; ++i) {
    double mass = 0.0;
    for (int k = p.begin[i]; k < p.begin[i + 1]; ++k) mass += a.values[k].trace();
    ratio[static_cast<std::size_t>(i)] = mass > 0.0 ? a.values[p.diagonal[i]].trace() / mass : 1.0;
  }
  if (ratio.empty()) return 1.0;
  const auto middle = ratio.begin() + p.rows / 2;
  std::nth_element(ratio.begin(), middle, ratio.end());
  return std::sqrt(*middle);
}

}  // namespace

double iterations_of_factor(const LinearSolver& direct, const BlockPattern& pattern) {
  const double work = direct.factor_work();
  return work > 0.0 ? kBesideWork + iterations_of_work(work, pattern) : 0.0;
}

double iterations_of_work(double operations, const BlockPattern& pattern) {
  return kOfWork * operations / iteration_work(pattern);
}

double iterations_at_least(const BlockMatrix& a) { return kIterations * stiffness_ratio(a); }

SolveStatus ThriftySolver::factorize(const BlockMatrix& a) {
  a_ = &a;
  worth_ = 0;
  if (iterative_.factor_work() > 0.0) return direct_.factorize(a);  // it was chosen to factorize: once is enough
  worth_ = static_cast<int>(iterations_of_factor(direct_, *a.pattern));
  return iterative_.factorize(a);
}

SolveReport ThriftySolver::solve(const VecX& b, VecX& x) {
  IMPINGE_ASSERT(a_ != nullptr);
  if (worth_ == 0) return chosen().solve(b, x);
  SolveReport report;
  if (iterations_at_least(*a_) < worth_) {
    const int most = iterative_.max_iterations;
    iterative_.max_iterations = std::min(most, worth_);
    report = iterative_.solve(b, x);
    iterative_.max_iterations = most;
    if (report.status != SolveStatus::not_converged) return report;
  }
  const SolveStatus status = direct_.factorize(*a_);
  if (status != SolveStatus::ok) return {status, report.iterations, 0.0};
  const int made = report.iterations;
  report = direct_.solve(b, x);
  report.iterations += made;
  return report;
}

SolveReport ThriftySolver::solve_many(const MatX& b, MatX& x) { return chosen().solve_many(b, x); }

LinearSolver& ThriftySolver::chosen() const { return iterative_.factor_work() > 0.0 ? direct_ : iterative_; }

}  // namespace impinge
