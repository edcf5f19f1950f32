// Semismooth Newton on Alart and Curnier's equations, regularised. Each step solves (A (W + α D) + B) Δλ = -F with D
// the scale of W's diagonal blocks: α makes redundant contacts (a singular W) harmless without moving the solution, as
// one step of a proximal point method that is taken before the inner problem is solved. α follows the residual, so the
// last steps are Newton's own: quadratic. [AcaryBremondHuber18] found Newton methods to be the accurate ones, and rank
// the difficulty.
//
// A step is halved until F has shrunk against the worst of the last few; if that fails α rises, and where even a large
// α does not help, a few Gauss-Seidel sweeps move on. F has kinks beside its zero (a contact whose λ and u are both
// nearly 0) along which short steps creep without end. Where they do and nothing better was met for long, a whole step
// is taken whatever it makes of F: the watchdog technique [Chamberlain82], without the way back, for going on from
// where that leads ends far more often. Cost of a step: one LU, of six rows a body where all bodies are rigid, else of
// the rows in contact.
#include <algorithm>
#include <cmath>
#include <deque>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/alart_curnier.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"
#include "engine/lcp/newton_system.hpp"

namespace impinge {
namespace {

// Gauss-Seidel, to begin with where a sweep costs little, and where Newton fails. Deformable surfaces meet in more
// contacts than they have unknowns: sweeps spread a λ over all of them that was of few, and Newton takes twice as many
// steps.
constexpr int kFirstSweeps = 3, kRescueSweeps = 5;
constexpr int kHalvings = 7;
constexpr std::size_t kMemory = 10;                  // steps that a new one is compared with
constexpr double kSmallest = 1e-12, kLargest = 1.0;  // α
constexpr double kFirstFactor = 10.0;                // α over the relative residual
constexpr double kAfterLeap = 1.0;                   // the same, of a whole step
constexpr int kLong = 40;                            // steps without 10 % gained after which it may leap
constexpr int kLongPerContact = 60;                  // and one more for so many contacts, which settle in turn
constexpr int kPatience = 8;                         // times as many without 1 % gained, and it gives up
constexpr std::size_t kCourse = 10;                  // steps that shrink F by less than kCreeps creep
constexpr double kCreeps = 0.9;
constexpr std::size_t kMostContacts = 6000;  // W written out takes 2.6 GB then

class Search {
 public:
  Search(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : problem_(problem),
        settings_(settings),
        lambda_(lambda),
        n_(lambda.size()),
        system_(newton_system(problem)),
        u_(n_),
        trial_(n_),
        a_(n_),
        b_(n_),
        kept_(n_) {
    for (std::size_t i = 0; i < n_; ++i) {
      rho_.push_back(alart_curnier_scale(problem, i));
      const Mat3& d = problem.w->diagonal(i);
      scale_.push_back(problem.has_one_row(i) ? d(0, 0) : d.trace() / 3.0);
    }
  }

  LcpResult run() {
    if (measure()) return finish(StopReason::converged);
    const int first = problem_.w->has_factors() ? kFirstSweeps : 0;
    while (iterations_ < std::min(first, settings_.max_iterations))
      if (sweep()) return finish(StopReason::converged);
    while (iterations_ < settings_.max_iterations) {
      if (iterations_ - best_at_ > kPatience * long_) return finish(StopReason::stagnated);
      if (creeps() ? leap() : step()) {
        ++iterations_;
        if (measure()) return finish(StopReason::converged);
        continue;
      }
      if (alpha_ < kLargest) {
        factor_ *= 10.0;
        ++iterations_;  // a factorization was spent
        note(residual_);
        continue;
      }
      factor_ = kFirstFactor;
      course_.clear();
      for (std::size_t i = 0; i < n_; ++i) lambda_[i] = problem_.nearest(i, lambda_[i]);
      for (int k = 0; k < kRescueSweeps && iterations_ < settings_.max_iterations; ++k)
        if (sweep()) return finish(StopReason::converged);
    }
    return finish(StopReason::iteration_cap);
  }

 private:
  bool sweep() {
    problem_.w->begin(lambda_);
    gauss_seidel_sweep(problem_, lambda_);
    ++iterations_;
    return measure();
  }

  /// The residual of λ brought into its cones; keeps the best.
  bool measure() {
    std::vector<Vec3> inside(n_);
    for (std::size_t i = 0; i < n_; ++i) inside[i] = problem_.nearest(i, lambda_[i]);
    problem_.w->begin(inside);
    velocities(problem_, u_);
    residual_ = relative_residual(problem_, u_, inside, settings_.measure);
    note(residual_);
    if (best_.empty() || residual_ < best_residual_) {
      if (best_.empty() || residual_ < 0.99 * best_residual_) best_at_ = iterations_;
      if (best_.empty() || residual_ < 0.9 * gained_) gained_ = residual_, gained_at_ = iterations_;
      best_ = std::move(inside);
      best_residual_ = residual_;
    }
    return residual_ <= settings_.tolerance;
  }
  void note(double residual) const {
    if (settings_.history != nullptr) settings_.history->push_back(residual);
  }
  LcpResult finish(StopReason reason) {
    lambda_ = best_;
    return {iterations_, reason};
  }

  /// ‖F‖² in velocities, at λ.
  double merit(const std::vector<Vec3>& lambda) {
    check_interrupt();
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      const Vec3 f = alart_curnier_value(problem_, i, u_[i], lambda[i], rho_[i]);
      if (rho_[i].x() > 0.0) sum += f.x() * f.x() / (rho_[i].x() * rho_[i].x());
      if (rho_[i].y() > 0.0) sum += f.tail<2>().squaredNorm() / (rho_[i].y() * rho_[i].y());
    }
    return sum;
  }

  bool creeps() const {
    return iterations_ - gained_at_ > long_ && course_.size() > kCourse && course_.back() > kCreeps * course_.front();
  }

  /// A whole step, wherever it leads.
  bool leap() {
    course_.clear();
    factor_ = kAfterLeap;
    problem_.w->begin(lambda_);
    velocities(problem_, u_);
    if (!find_direction()) return false;
    for (std::size_t i = 0; i < n_; ++i) lambda_[i] += direction(i);
    return true;
  }

  /// One regularised Newton step with its line search; false if no length served (λ is as before).
  bool step() {
    const double now = merit(lambda_);
    if (!find_direction()) return false;
    double worst = now;
    const std::size_t compared = std::min(course_.size(), kMemory - 1);
    for (auto m = course_.end() - static_cast<std::ptrdiff_t>(compared); m != course_.end(); ++m)
      worst = std::max(worst, *m);
    double length = 1.0;
    for (int k = 0; k <= kHalvings; ++k, length *= 0.5) {
      for (std::size_t i = 0; i < n_; ++i) trial_[i] = lambda_[i] + length * direction(i);
      if (!(merit(trial_) <= (1.0 - 1e-4 * length) * worst)) continue;
      lambda_ = trial_;
      course_.push_back(now);
      if (course_.size() > kCourse + 1) course_.pop_front();
      if (length > 0.4)
        factor_ = std::max(0.5 * factor_, 1e-3);
      else if (length < 0.2)
        factor_ *= 2.0;
      return true;
    }
    return false;
  }

  Vec3 direction(std::size_t i) const { return direction_.segment<3>(3 * static_cast<Eigen::Index>(i)); }

  /// Newton's, from the present λ and its u; false if there is none.
  bool find_direction() {
    alpha_ = std::clamp(factor_ * residual_, kSmallest, kLargest);
    VecX f(static_cast<Eigen::Index>(3 * n_));
    for (std::size_t i = 0; i < n_; ++i) {
      const AlartCurnier e = alart_curnier(problem_, i, u_[i], lambda_[i], rho_[i]);
      a_[i] = e.by_u;
      b_[i] = e.by_lambda + alpha_ * scale_[i] * e.by_u;
      kept_[i] = !e.open;
      f.segment<3>(3 * static_cast<Eigen::Index>(i)) = -e.value;
    }
    system_->factorize(a_, b_, kept_);
    system_->solve(f, direction_);
    return direction_.allFinite();
  }

  const ConeProblem& problem_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  const int long_ = kLong + static_cast<int>(n_) / kLongPerContact;
  std::unique_ptr<NewtonSystem> system_;
  std::vector<Vec2> rho_;
  std::vector<double> scale_;
  std::vector<Vec3> u_, trial_, best_;
  std::vector<Mat3> a_, b_;
  std::vector<char> kept_;
  VecX direction_;
  std::deque<double> course_;  // merits that were stepped from
  double residual_ = 0.0, best_residual_ = 0.0, alpha_ = 0.0, factor_ = kFirstFactor;
  double gained_ = 0.0;
  int iterations_ = 0, best_at_ = 0, gained_at_ = 0;
};

class SemismoothNewton : public LcpSolver {
 public:
  int reference_rank() const override { return 1; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    if (!applies(problem).empty()) return {0, StopReason::refused};
    return Search(problem, settings, lambda).run();
  }
  std::string applies(const ConeProblem& problem) const override {
    if (problem.q.size() <= kMostContacts) return "";
    if (problem.w != nullptr && (problem.w->body_space() != nullptr || problem.w->node_space() != nullptr)) return "";
    return std::to_string(problem.q.size()) + " contacts; it writes W out, which is done up to " +
           std::to_string(kMostContacts);
  }
};

}  // namespace

Entry<LcpSolver> semismooth_newton_solver() {
  return entry<LcpSolver, SemismoothNewton>(
      "semismooth_newton", "regularised Newton on Alart-Curnier's equations; quadratic near the solution");
}

}  // namespace impinge
