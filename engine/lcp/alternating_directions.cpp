// The alternating direction method of multipliers, ADMM [Tasora21], in the velocities of the bodies: in turn each contact
// is projected onto its cone, by itself, and all bodies are moved together by one sparse factorization of M + Jᵀ P J,
// which knows nothing of the contacts' number. P is a number a contact, κ over its W_ii. De Saxcé's shift is renewed in
// every iteration [DeSaxce98], so that what it ends at is Coulomb's law and not the associated one.
//
// κ decides how soon forces go through the whole: stacks and chains want much, tumbling piles little. It begins high and
// comes down where the residual doesn't. (To end where the lowest doesn't serve either leaves bridges of planks unsolved
// that it solves in time.)
#include "engine/lcp/alternating_directions.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr double kRelaxation = 1.6;
constexpr double kWeights[] = {1000.0, 100.0, 10.0};  // κ, in this order
constexpr int kLook = 10;                             // iterations from one residual to the next
constexpr int kPatience = 60;  // iterations in which a weight that serves lowers the residual by kServes
constexpr double kServes = 0.5;
constexpr double kWarm = 0.1;  // a λ that is farther off is worse than none, whose residual is at most 1

class Iteration {
 public:
  Iteration(const ConeProblem& problem, const BodySpace& bodies, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : problem_(problem),
        bodies_(bodies),
        settings_(settings),
        lambda_(lambda),
        n_(lambda.size()),
        matrix_(bodies),
        weight_(n_),
        y_(n_),
        w_(n_),
        z_(n_),
        u_(n_) {}

  LcpResult run() {
    if (measure(lambda_)) return finish(0, StopReason::converged);
    std::size_t level = 0;
    const std::vector<Vec3> nothing(n_, Vec3::Zero());
    bool is_cold = best_residual_ > kWarm;
    weigh(kWeights[level]);
    start(is_cold ? nothing : best_);
    double before = 0.0;  // the residual where this span of iterations began; 0: it has just begun
    int since = 0;
    for (int i = 1; i <= settings_.max_iterations; ++i) {
      step();
      const bool looks = i % kLook == 0 || i == settings_.max_iterations;
      if (looks) {
        std::vector<Vec3> now(n_);
        for (std::size_t k = 0; k < n_; ++k) now[k] = weight_[k] * z_[k];
        if (measure(now)) return finish(i, StopReason::converged);
        if (before == 0.0) before = residual_;
      } else if (settings_.history != nullptr) {
        settings_.history->push_back(settings_.history->back());
      }
      if (++since < kPatience) continue;
      since = 0;
      const bool serves = residual_ < kServes * before;
      before = serves ? residual_ : 0.0;
      if (serves) continue;
      if (!is_cold) {
        is_cold = true;
        start(nothing);
      } else if (level + 1 < std::size(kWeights)) {
        weigh(kWeights[++level]);
        start(best_);
      }
    }
    return finish(settings_.max_iterations, StopReason::iteration_cap);
  }

 private:
  /// Notes the residual of λ, keeps the best.
  bool measure(const std::vector<Vec3>& lambda) {
    check_interrupt();
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    residual_ = relative_residual(problem_, u_, lambda, settings_.measure);
    if (settings_.history != nullptr) settings_.history->push_back(residual_);
    if (best_.empty() || residual_ < best_residual_) best_ = lambda, best_residual_ = residual_;
    return residual_ <= settings_.tolerance;
  }
  LcpResult finish(int iterations, StopReason reason) {
    lambda_ = best_;
    return {iterations, reason};
  }

  /// P = κ / W_ii from here on.
  void weigh(double kappa) {
    check_interrupt();
    std::vector<Mat3> g(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      const Mat3& d = problem_.w->diagonal(i);
      const double scale = problem_.has_one_row(i) ? d(0, 0) : d.trace() / 3.0;
      weight_[i] = scale > 0.0 ? kappa / scale : 0.0;
      g[i] = weight_[i] * Mat3::Identity();
    }
    matrix_.factorize(g);
  }

  /// From λ, with the present weights.
  void start(const std::vector<Vec3>& lambda) {
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    for (std::size_t i = 0; i < n_; ++i)
      y_[i] = weight_[i] > 0.0 ? Vec3(problem_.dual(i, u_[i]) - lambda[i] / weight_[i]) : Vec3(Vec3::Zero());
  }

  void step() {
    VecX v = bodies_.no_velocities();
    for (std::size_t i = 0; i < n_; ++i) {
      z_[i] = problem_.nearest(i, -y_[i]);
      w_[i] = y_[i] + z_[i];
      Vec3 wanted = w_[i];
      if (problem_.kind_of(i) == RowKind::contact && problem_.mu[i] > 0.0)
        wanted.x() -= problem_.mu[i] * std::hypot(w_[i].y(), w_[i].z());
      bodies_.push(i, weight_[i] * (z_[i] + wanted - problem_.q[i]), v);
    }
    matrix_.solve(v);
    for (std::size_t i = 0; i < n_; ++i) {
      if (weight_[i] == 0.0) continue;
      const Vec3 u = problem_.q[i] + bodies_.relative(i, v);
      y_[i] = kRelaxation * problem_.dual(i, u) + (1.0 - kRelaxation) * w_[i] - z_[i];
    }
  }

  const ConeProblem& problem_;
  const BodySpace& bodies_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  BodyMatrix matrix_;
  std::vector<double> weight_;   // P, kg
  std::vector<Vec3> y_, w_, z_;  // m/s: what is projected, its parts in the dual cone and, turned round, in the cone
  std::vector<Vec3> u_, best_;
  double residual_ = 0.0, best_residual_ = 0.0;
};

}  // namespace

bool can_alternate_directions(const ConeProblem& problem) {
  return problem.law == FrictionLaw::cone && problem.w->body_space() != nullptr;
}

LcpResult alternate_directions(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) {
  if (problem.q.empty()) return {};
  return Iteration(problem, *problem.w->body_space(), settings, lambda).run();
}

}  // namespace impinge
