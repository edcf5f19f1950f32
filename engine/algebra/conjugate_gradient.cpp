// Conjugate gradients with the inverse 3 × 3 diagonal blocks as preconditioner. For the single right-hand side of an
// implicit step: M dominates A there, so it takes tens of iterations, starting from the last velocity.
#include <Eigen/LU>
#include <cmath>

#include "engine/algebra/linear_solver.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

class ConjugateGradient : public LinearSolver {
 public:
  void analyze(const BlockPattern& pattern) override { inverse_.resize(pattern.rows); }

  SolveStatus factorize(const BlockMatrix& a) override {
    IMPINGE_ASSERT(static_cast<int>(inverse_.size()) == a.pattern->rows);
    a_ = &a;
    bool finite = true, positive = true;
    for (int i = 0; i < a.pattern->rows; ++i) {
      const Mat3& d = a.values[a.pattern->diagonal[i]];
      finite = finite && d.allFinite();
      positive = positive && d(0, 0) > 0.0 && d(0, 0) * d(1, 1) > d(0, 1) * d(1, 0) && d.determinant() > 0.0;
      inverse_[i] = d.inverse();
    }
    return status_ = !finite     ? SolveStatus::not_finite
                     : !positive ? SolveStatus::not_positive_definite
                                 : SolveStatus::ok;
  }

  SolveReport solve(const VecX& b, VecX& x) override {
    IMPINGE_ASSERT(a_ != nullptr && b.size() == a_->rows());
    if (x.size() != b.size()) x.setZero(b.size());
    if (status_ != SolveStatus::ok) return {status_, 0, 0.0};
    const double b_norm = std::sqrt(dot(b, b));
    if (!std::isfinite(b_norm)) return {SolveStatus::not_finite, 0, 0.0};
    if (b_norm == 0.0) {
      x.setZero();
      return {};
    }
    const double goal = tolerance * b_norm;
    multiply(*a_, x, q_);
    r_ = b - q_;
    precondition();
    p_ = z_;
    double rz = dot(r_, z_), r_norm = std::sqrt(dot(r_, r_));
    SolveReport report;
    while (r_norm > goal && report.iterations < max_iterations) {
      check_interrupt();
      multiply(*a_, p_, q_);
      const double curvature = dot(p_, q_);
      if (!(curvature > 0.0))
        return {std::isfinite(curvature) ? SolveStatus::not_positive_definite : SolveStatus::not_finite,
                report.iterations, r_norm / b_norm};
      const double alpha = rz / curvature;
      x += alpha * p_;
      r_ -= alpha * q_;
      precondition();
      const double next = dot(r_, z_);
      p_ = z_ + (next / rz) * p_;
      rz = next;
      r_norm = std::sqrt(dot(r_, r_));
      ++report.iterations;
    }
    report.residual = r_norm / b_norm;
    if (!(r_norm <= goal)) report.status = std::isfinite(r_norm) ? SolveStatus::not_converged : SolveStatus::not_finite;
    return report;
  }

  SolveReport solve_many(const MatX& b, MatX& x) override {
    SolveReport worst;
    const bool warm = x.rows() == b.rows() && x.cols() == b.cols();
    if (!warm) x.setZero(b.rows(), b.cols());
    VecX column;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      column = x.col(j);
      const SolveReport report = solve(b.col(j), column);
      x.col(j) = column;
      worst.iterations = std::max(worst.iterations, report.iterations);
      worst.residual = std::max(worst.residual, report.residual);
      if (report.status != SolveStatus::ok) worst.status = report.status;
    }
    return worst;
  }

 private:
  void precondition() {
    z_.resize(r_.size());
    for (std::size_t i = 0; i < inverse_.size(); ++i)
      z_.segment<3>(3 * i).noalias() = inverse_[i] * r_.segment<3>(3 * i);
  }

  const BlockMatrix* a_ = nullptr;
  SolveStatus status_ = SolveStatus::ok;
  std::vector<Mat3> inverse_;
  VecX r_, z_, p_, q_;
};

}  // namespace

Entry<LinearSolver> conjugate_gradient_solver() {
  return entry<LinearSolver, ConjugateGradient>("conjugate_gradient",
                                                "conjugate gradients, preconditioned by 3 x 3 diagonal blocks");
}

}  // namespace impinge
