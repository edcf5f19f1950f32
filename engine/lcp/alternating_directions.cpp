// The alternating direction method of multipliers, ADMM [Tasora21], in the velocities of the bodies: in turn each contact
// is projected onto its cone, by itself, and all bodies are moved together by one sparse factorization of M + Jᵀ P J,
// which knows nothing of the contacts' number. P is a number a contact, κ over its W_ii. De Saxcé's shift is renewed in
// every iteration [DeSaxce98], so that what it ends at is Coulomb's law and not the associated one.
//
// κ decides what is brought together soon: forces through the whole where it is large, the cone of each contact where it
// is small, and either creeps at the other's work. So a strong and a weak one have turns, with two factorizations: on 16
// frozen steps of a heap of a thousand boxes, from relative residuals of 0.03 to 0.2 down to 1e-3, the best single κ, 5,
// took 700 iterations in the mean and ended 6 of 16 in 800, 60 and 4 in turns of 60 took 290 and ended all. Three in turn
// did no better, turns of 20 and 40 worse, and so did strong ones beyond 100, weak ones beyond 5. From a λ that is near the weak
// one begins. (A stack from nothing wants 1,000; those are Newton's.)
#include "engine/lcp/alternating_directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr double kRelaxation = 1.6;
constexpr double kStrong = 60.0, kWeak = 4.0;  // κ
constexpr double kNear = 1e-2;                 // a relative residual
constexpr int kTurn = 60;                      // iterations with one κ
constexpr double kOfEquations = 100.0;         // over it: no projection ends what is free
constexpr int kLook = 20;                      // iterations from one residual to the next
constexpr int kSpan = 2 * kTurn;               // iterations from one look at how the best residual falls to the next
constexpr double kMostSpans = 4.0;             // that may be left by what the last one gained
constexpr std::size_t kSummed = 1024;          // contacts that are summed up together

class Alternation {
 public:
  Alternation(const ConeProblem& problem, const BodySpace& bodies, const LcpSettings& settings,
              std::vector<Vec3>& lambda)
      : problem_(problem),
        bodies_(bodies),
        settings_(settings),
        lambda_(lambda),
        n_(lambda.size()),
        weight_(n_),
        y_(n_),
        z_(n_),
        u_(n_),
        sums_((n_ + kSummed - 1) / kSummed) {}

  LcpResult run() {
    if (measure(lambda_)) return finish(0, StopReason::converged);
    is_strong_ = best_residual_ > kNear;
    weigh();
    start();
    double before = best_residual_;
    for (int i = 1; i <= settings_.max_iterations; ++i) {
      if (i > 1 && i % kTurn == 1) turn();
      step();
      if (i % kLook == 0 || i == settings_.max_iterations) {
        std::vector<Vec3> now(n_);
        for (std::size_t k = 0; k < n_; ++k) now[k] = weight_[k] * z_[k];
        if (measure(now)) return finish(i, StopReason::converged);
      } else if (settings_.history != nullptr) {
        settings_.history->push_back(settings_.history->back());
      }
      if (i % kSpan != 0) continue;
      const double left = std::log(settings_.tolerance / best_residual_) / std::log(best_residual_ / before);
      if (i > kSpan && !(left <= kMostSpans)) return finish(i, StopReason::stagnated);
      before = best_residual_;
    }
    return finish(settings_.max_iterations, StopReason::iteration_cap);
  }

 private:
  /// Notes the residual of λ, keeps the best.
  bool measure(const std::vector<Vec3>& lambda) {
    check_interrupt();
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    const double residual = relative_residual(problem_, u_, lambda, settings_.measure);
    if (settings_.history != nullptr) settings_.history->push_back(residual);
    if (best_.empty() || residual < best_residual_) best_ = lambda, best_residual_ = residual;
    return residual <= settings_.tolerance;
  }
  LcpResult finish(int iterations, StopReason reason) {
    lambda_ = best_;
    return {iterations, reason};
  }

  double kappa() const { return is_strong_ ? kStrong : kWeak; }

  /// P, and the factorization with it, which is made once.
  void weigh() {
    for (std::size_t i = 0; i < n_; ++i) {
      const double scale = diagonal_scale(problem_, i);
      const double factor = problem_.kind_of(i) == RowKind::contact ? 1.0 : kOfEquations;
      weight_[i] = scale > 0.0 ? factor * kappa() / scale : 0.0;
    }
    const std::optional<BodyMatrix>& other = matrices_[!is_strong_];
    std::optional<BodyMatrix>& mine = matrices_[is_strong_];
    if (mine) return;
    mine.emplace(other ? *other : BodyMatrix(bodies_));  // which has the same pattern
    std::vector<Mat3> g(n_);
    for (std::size_t i = 0; i < n_; ++i) g[i] = weight_[i] * Mat3::Identity();
    mine->factorize(g);
  }

  /// The other P, with the same λ and velocities.
  void turn() {
    const double before = kappa();
    is_strong_ = !is_strong_;
    weigh();
    for_strips([&](std::size_t i, VecX& sum) {
      y_[i] += (1.0 - before / kappa()) * z_[i];
      project(i, sum);
    });
  }

  /// From λ, whose velocities measure() has left.
  void start() {
    for_strips([&](std::size_t i, VecX& sum) {
      y_[i] = problem_.dual(i, u_[i]) - lambda_[i] / weight_[i];
      project(i, sum);
    });
  }

  /// All bodies together, then each contact by itself.
  void step() {
    matrices_[is_strong_]->solve(wanted_);
    for_strips([&](std::size_t i, VecX& sum) {
      const Vec3 u = problem_.q[i] + bodies_.relative(i, wanted_);
      y_[i] = kRelaxation * problem_.dual(i, u) + (1.0 - kRelaxation) * (y_[i] + z_[i]) - z_[i];
      project(i, sum);
    });
  }

  /// y in its two parts, and what the next velocities are to come to.
  void project(std::size_t i, VecX& sum) {
    z_[i] = problem_.nearest(i, -y_[i]);
    Vec3 wanted = y_[i] + z_[i];
    if (problem_.kind_of(i) == RowKind::contact) wanted.x() -= problem_.dual(i, wanted).x() - wanted.x();
    bodies_.push(i, weight_[i] * (z_[i] + wanted - problem_.q[i]), sum);
  }

  /// Of contacts whose bodies can respond; what each adds goes by strips, whatever the threads are.
  template <class Do>
  void for_strips(Do&& of_contact) {
    parallel_for(sums_.size(), 1, [&](std::size_t strip) {
      sums_[strip] = bodies_.no_velocities();
      for (std::size_t i = strip * kSummed; i < std::min(n_, (strip + 1) * kSummed); ++i)
        if (weight_[i] > 0.0) of_contact(i, sums_[strip]);
    });
    wanted_ = sums_.front();
    for (std::size_t strip = 1; strip < sums_.size(); ++strip) wanted_ += sums_[strip];
  }

  const ConeProblem& problem_;
  const BodySpace& bodies_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  bool is_strong_ = false;
  std::array<std::optional<BodyMatrix>, 2> matrices_;  // of the weak κ, of the strong one; made when it has its turn
  std::vector<double> weight_;                         // P, kg
  std::vector<Vec3> y_, z_;  // m/s: what is projected, and what of it is in the cone, turned round
  std::vector<Vec3> u_, best_;
  std::vector<VecX> sums_;
  VecX wanted_;  // Jᵀ of what contacts want, kg m/s; solved: the velocities
  double best_residual_ = 0.0;
};

}  // namespace

LcpResult alternate_directions(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) {
  if (problem.q.empty()) return {};
  return Alternation(problem, *problem.w->body_space(), settings, lambda).run();
}

}  // namespace impinge
