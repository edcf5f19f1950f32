// Accelerated projected gradients, APGD [Nesterov83], [Mazhar15]: λ⁺ = P_K(y - t D⁻¹ (W y + q + s)) with y extrapolated
// from the last two λ, restarted where the step turns against it. Whole products W y only: the method for wide
// machines.
//
// Its model is the convex problem in which the shift s_i = mu_i |u_iT| of Coulomb's law is held; without the shift,
// sliding would lift bodies. s follows u: an outer fixed point, moved on whenever the convex problem is solved well
// enough for it. D is the size of W's diagonal blocks; the step t comes from the curvature met (backtracking), and
// grows again slowly.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr double kInner = 0.3;    // the convex problem is solved to this share of the whole residual
constexpr double kGrowth = 1.05;  // of the step, an iteration
constexpr int kPatience = 2000;   // iterations without a better residual before giving up

class Descent {
 public:
  Descent(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : problem_(problem),
        settings_(settings),
        lambda_(lambda),
        n_(lambda.size()),
        shift_(n_, 0.0),
        w_lambda_(n_),
        u_(n_),
        next_(n_),
        w_next_(n_) {
    for (std::size_t i = 0; i < n_; ++i) {
      const double size = diagonal_scale(problem, i);
      scale_.push_back(size > 0.0 ? size : 1.0);
    }
  }

  LcpResult run() {
    apply(lambda_, w_lambda_);
    if (measure()) return {0, StopReason::converged};
    move_shift();
    std::vector<Vec3> y = lambda_, w_y = w_lambda_;
    double theta = 1.0, step = 1.0;
    for (int k = 1; k <= settings_.max_iterations; ++k) {
      for (;;) {
        check_interrupt();
        for (std::size_t i = 0; i < n_; ++i)
          next_[i] = problem_.nearest(i, y[i] - step / scale_[i] * gradient(i, w_y[i]));
        apply(next_, w_next_);
        double curve = 0.0, model = 0.0;
        for (std::size_t i = 0; i < n_; ++i) {
          const Vec3 d = next_[i] - y[i];
          curve += d.dot(w_next_[i] - w_y[i]);
          model += scale_[i] * d.squaredNorm();
        }
        if (!(curve * step > model * (1.0 + 1e-12)) || step < 1e-12) break;
        step = std::min(0.5 * step, 0.95 * model / curve);
      }
      double turn = 0.0;
      for (std::size_t i = 0; i < n_; ++i) turn += scale_[i] * (y[i] - next_[i]).dot(next_[i] - lambda_[i]);
      if (turn > 0.0) theta = 1.0;
      const double after = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * theta * theta)),
                   beta = turn > 0.0 ? 0.0 : (theta - 1.0) / after;
      theta = after;
      for (std::size_t i = 0; i < n_; ++i) {  // W y follows from the products at hand
        y[i] = next_[i] + beta * (next_[i] - lambda_[i]);
        w_y[i] = w_next_[i] + beta * (w_next_[i] - w_lambda_[i]);
      }
      std::swap(lambda_, next_);
      std::swap(w_lambda_, w_next_);
      step *= kGrowth;
      if (measure()) return {k, StopReason::converged};
      if (residual_ < 0.99 * best_) best_ = residual_, best_at_ = k;
      if (k - best_at_ > kPatience || !std::isfinite(residual_)) return {k, StopReason::stagnated};
      if (convex_residual() <= kInner * residual_) move_shift();
    }
    return {settings_.max_iterations, StopReason::iteration_cap};
  }

 private:
  void apply(const std::vector<Vec3>& x, std::vector<Vec3>& y) {
    problem_.w->apply(x, y);
    for (std::size_t i = 0; i < n_; ++i)
      if (problem_.has_one_row(i)) y[i].tail<2>().setZero();
  }
  Vec3 gradient(std::size_t i, const Vec3& product) const {
    Vec3 g = product + problem_.q[i];
    g.x() += shift_[i];
    if (problem_.has_one_row(i)) g.tail<2>().setZero();
    return g;
  }
  bool measure() {
    for (std::size_t i = 0; i < n_; ++i) u_[i] = w_lambda_[i] + problem_.q[i];
    residual_ = relative_residual(problem_, u_, lambda_, settings_.measure);
    if (settings_.history != nullptr) settings_.history->push_back(residual_);
    return residual_ <= settings_.tolerance;
  }
  /// How well λ solves the problem whose shift is held: the judge's natural map with that shift.
  double convex_residual() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      const Vec3 z = lambda_[i] - gradient(i, w_lambda_[i]) / scale_[i];
      worst = std::max(worst, scale_[i] * (lambda_[i] - problem_.nearest(i, z)).norm());
    }
    return worst / std::max(velocity_scale(problem_), 1e-300);
  }
  void move_shift() {
    for (std::size_t i = 0; i < n_; ++i) shift_[i] = problem_.dual(i, u_[i]).x() - u_[i].x();
  }

  const ConeProblem& problem_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  std::vector<double> scale_, shift_;
  std::vector<Vec3> w_lambda_, u_, next_, w_next_;
  double residual_ = 0.0, best_ = 1e300;
  int best_at_ = 0;
};

class AcceleratedProjectedGradient : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    return Descent(problem, settings, lambda).run();
  }
};

}  // namespace

Entry<LcpSolver> accelerated_projected_gradient_solver() {
  return entry<LcpSolver, AcceleratedProjectedGradient>(
      "accelerated_projected_gradient", "APGD: Nesterov's method on the cone, with Coulomb's shift as a fixed point");
}

}  // namespace impinge
