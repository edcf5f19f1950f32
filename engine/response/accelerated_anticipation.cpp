// Each outer step minimises, under the contacts' laws, a quadratic that lies above ½ Δv^T A Δv and touches it at a point y:
//   r = A y - J^T λ,   Δv = y - Q⁻¹ r,   Gauss-Seidel sweeps over the contacts on J Q⁻¹ J^T, which move Δv as they move λ,
// with Q of NodeInverse (Q >= A, checked along every step, since the power method only comes near λ_max from below). y by
// Nesterov's rule, restarted where the step turns against it. Without friction this is a majorise-minimise scheme on a convex
// problem; with Coulomb's law it converged in every run that was made.
//
// The start is λ of the last sub-step and Δv = A⁻¹ J^T λ by conjugate gradients, as accurate as the contacts then hold: a resting
// group is recognized, and no work is spent on a λ that is far off.
#include "engine/response/accelerated_anticipation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/response/split_rows.hpp"

namespace impinge {
namespace {

constexpr int kSweeps = 4;        // a step at most; they start from the last step's λ
constexpr int kStartSteps = 400;  // of conjugate gradients at most
constexpr int kStartCheck = 8;    // steps between looks at what the contacts make of it
constexpr double kStartAccuracy = 1e-3;  // of the contacts' residual: error of stiff bodies is far above D⁻¹ times their residual
constexpr int kFreshRigid = 32;   // steps after which rigid Δv is summed up afresh, lest rounding gathers

using Vectors = std::vector<VecX>;

double inner(const Vectors& a, const Vectors& b) {
  double sum = 0.0;
  for (std::size_t s = 0; s < a.size(); ++s) sum += dot(a[s], b[s]);
  return sum;
}

class Solver {
 public:
  Solver(GroupSystem& group, const ConeProblem& base, const ResponseSettings& settings) : group_(group), settings_(settings) {
    for (const SoftBlock& block : group.soft) inverse_.emplace_back(block);
    rows_ = std::make_unique<SplitRows>(group, inverse_, base.q);
    for (const Vec3& q : base.q) scale_ = std::max(scale_, q.norm());
    for (Vectors* v : {&x_, &last_, &y_, &a_x_, &a_last_, &a_y_, &f_, &r_, &step_})
      for (const SoftBlock& block : group.soft) v->push_back(VecX::Zero(block.velocity.size()));
  }

  ResponseResult run() {
    ResponseResult result;
    const double tolerance = settings_.lcp.tolerance * scale_;
    rows_->move_rigid(group_.lambda);
    rows_->impulses(group_.lambda, f_);
    start(tolerance);
    double theta = 1.0, before = -1.0, momentum = momentum_residual();
    result.converged = momentum <= tolerance && rows_->natural_residual(group_.lambda, x_) <= tolerance;
    while (!result.converged && result.outer_iterations < settings_.max_outer_iterations) {
      for (std::size_t s = 0; s < x_.size(); ++s) {
        std::swap(last_[s], x_[s]);
        std::swap(a_last_[s], a_x_[s]);
        r_[s] = a_y_[s] - f_[s];
        inverse_[s].step(y_[s], r_[s], x_[s]);
      }
      if (result.outer_iterations % kFreshRigid == 0) rows_->move_rigid(group_.lambda);
      double change = 0.0;
      for (int k = 0; k < kSweeps; ++k) {
        change = rows_->sweep(group_.lambda, x_);
        ++result.iterations;
        if (change <= 0.3 * tolerance || change <= 0.1 * momentum) break;
      }
      ++result.outer_iterations;
      const bool contacts_hold = change <= 2.0 * tolerance && rows_->natural_residual(group_.lambda, x_) <= tolerance;
      rows_->impulses(group_.lambda, f_);
      for (std::size_t s = 0; s < x_.size(); ++s) {
        multiply(*group_.soft[s].a, x_[s], a_x_[s]);
      }
      momentum = momentum_residual();
      if (settings_.stop == "change") {
        const double size = momentum_norm();
        result.converged = size == 0.0 || (before >= 0.0 && std::abs(size - before) < kSeedChange * before);
        before = size;
      } else {
        result.converged = contacts_hold && momentum <= tolerance;
      }
      if (result.converged) break;
      extrapolate(theta);
    }
    rows_->move_rigid(group_.lambda);
    group_.soft_delta = x_;
    return result;
  }

 private:
  /// x = y = A⁻¹ J^T λ, nearly.
  void start(double tolerance) {
    if (momentum_norm() == 0.0) return;
    Vectors direction = x_, a_direction = x_;
    double rho = 0.0;
    for (int k = 0; k < kStartSteps; ++k) {
      for (std::size_t s = 0; s < x_.size(); ++s) {  // step_ = Q⁻¹ (f - A x)
        r_[s] = a_x_[s] - f_[s];
        inverse_[s].step(last_[s], r_[s], step_[s]);
      }
      const double next = -inner(step_, r_), beta = k > 0 ? next / rho : 0.0;
      rho = next;
      for (std::size_t s = 0; s < x_.size(); ++s) {
        direction[s] = step_[s] + beta * direction[s];
        multiply(*group_.soft[s].a, direction[s], a_direction[s]);
      }
      const double curvature = inner(direction, a_direction);
      if (!(curvature > 0.0)) break;
      for (std::size_t s = 0; s < x_.size(); ++s) {
        x_[s] += rho / curvature * direction[s];
        a_x_[s] += rho / curvature * a_direction[s];
      }
      if (k % kStartCheck == kStartCheck - 1 && momentum_residual() <= std::max(0.3 * tolerance, kStartAccuracy * rows_->natural_residual(group_.lambda, x_))) break;
    }
    y_ = x_;
    a_y_ = a_x_;
  }

  void extrapolate(double& theta) {
    double turn = 0.0;
    for (std::size_t s = 0; s < x_.size(); ++s) {
      // Q d = J^T λ - A y along the step d = x - y that was taken: Q >= A asks d·A d <= d·Q d
      step_[s] = x_[s] - y_[s];
      r_[s] = a_y_[s] - f_[s];
      const double q_norm = -dot(step_[s], r_[s]), a_norm = dot(step_[s], a_x_[s]) - dot(step_[s], a_y_[s]);
      if (a_norm > 1.001 * q_norm && q_norm > 1e-20 * dot(x_[s], a_x_[s])) {
        inverse_[s].shrink(1.05 * a_norm / q_norm);
        changed_ = true;
      }
      turn += dot(r_[s], x_[s]) - dot(r_[s], last_[s]);
    }
    if (changed_) rows_->prepare();
    changed_ = false;
    const bool restart = turn > 0.0;
    if (restart) theta = 1.0;
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * theta * theta));
    const double beta = restart ? 0.0 : (theta - 1.0) / next;
    for (std::size_t s = 0; s < x_.size(); ++s) {
      y_[s] = x_[s] + beta * (x_[s] - last_[s]);
      a_y_[s] = a_x_[s] + beta * (a_x_[s] - a_last_[s]);
    }
    theta = next;
  }

  /// max |D⁻¹ (A Δv - J^T λ)| over nodes, m/s. Leaves A Δv - J^T λ in r_.
  double momentum_residual() {
    double largest = 0.0;
    for (std::size_t s = 0; s < x_.size(); ++s) {
      r_[s] = a_x_[s] - f_[s];
      largest = std::max(largest, inverse_[s].velocity_of(r_[s]));
    }
    return largest;
  }

  double momentum_norm() const {
    double sum = 0.0;
    for (std::size_t s = 0; s < x_.size(); ++s) sum += (a_x_[s] - f_[s]).squaredNorm();
    return std::sqrt(sum);
  }

  GroupSystem& group_;
  const ResponseSettings& settings_;
  std::vector<NodeInverse> inverse_;
  std::unique_ptr<SplitRows> rows_;
  Vectors x_, last_, y_, a_x_, a_last_, a_y_, f_, r_, step_;
  double scale_ = 0.0;
  bool changed_ = false;
};

}  // namespace

ResponseResult solve_accelerated(GroupSystem& group, const ConeProblem& base, const ResponseSettings& settings) {
  return Solver(group, base, settings).run();
}

}  // namespace impinge
