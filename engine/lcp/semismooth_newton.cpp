// Semismooth Newton on Alart and Curnier's equations, regularised. Each step solves (A (W + α D) + B) Δλ = -F with D
// the scale of W's diagonal blocks: α makes redundant contacts (a singular W) harmless without moving the solution, as
// one step of a proximal point method that is taken before the inner problem is solved. α follows the residual, so the
// last steps are Newton's own: quadratic. [AcaryBremondHuber18] found Newton methods to be the accurate ones, and rank
// the difficulty.
//
// Links that carry far more than their mobility lets them (a load of 1e5 times on a light rod) have a W whose least eigenvalue
// is far below any α that follows the residual, which stays where it is as long as α does. What is left after a whole step
// tells: where that is what α asked for and nothing else, α falls by 100 at once.
//
// A step is halved until F has shrunk against the worst of the last few; if that fails α rises, and where even a large
// α does not help, a few Gauss-Seidel sweeps move on. F has kinks beside its zero (a contact whose λ and u are both
// nearly 0) along which short steps creep without end. Where they do and nothing better was met for long, a whole step
// is taken whatever it makes of F: the watchdog technique [Chamberlain82], without the way back, for going on from
// where that leads ends far more often. Cost of a step: one LU, of six rows a body where all bodies are rigid, else of
// the rows in contact.
#include <algorithm>
#include <cmath>

#include "engine/lcp/newton_search.hpp"

namespace impinge {
namespace {

// Gauss-Seidel, to begin with where a sweep costs little, and where Newton fails. Deformable surfaces meet in more
// contacts than they have unknowns: sweeps spread a λ over all of them that was of few, and Newton takes twice as many
// steps.
constexpr int kFirstSweeps = 3, kRescueSweeps = 5;
constexpr double kFirstFactor = 10.0;  // α over the relative residual
constexpr double kLeastFactor = 1e-3;  // that whole steps lead to
constexpr double kRelease = 0.01;      // what becomes of α where nothing else is in the way
constexpr double kAfterLeap = 1.0;     // the same, of a whole step
constexpr int kLong = 40;              // steps without 10 % gained after which it may leap
constexpr int kLongPerContact = 60;    // and one more for so many contacts, which settle in turn
constexpr int kPatience = 8;           // times as many without 1 % gained, and it gives up
constexpr double kCreeps = 0.9;        // as many steps as are remembered that shrink F by less creep

class Search : NewtonSearch {
 public:
  Search(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : NewtonSearch(problem, settings, lambda) {}

  LcpResult run() {
    if (look()) return finish(StopReason::converged);
    const int first = problem_.w->has_factors() ? kFirstSweeps : 0;
    while (iterations_ < std::min(first, settings_.max_iterations))
      if (sweep_and_look()) return finish(StopReason::converged);
    while (iterations_ < settings_.max_iterations) {
      if (iterations_ - best_at_ > kPatience * long_) return finish(StopReason::stagnated);
      if (creeps() ? leap() : step()) {
        ++iterations_;
        if (look()) return finish(StopReason::converged);
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
        if (sweep_and_look()) return finish(StopReason::converged);
    }
    return finish(StopReason::iteration_cap);
  }

 private:
  bool look() { return remember(measure()); }
  bool sweep_and_look() { return remember(sweep()); }

  /// When the best was met.
  bool remember(bool solved) {
    if (residual_ == best_residual_) {
      if (residual_ < 0.99 * last_best_) best_at_ = iterations_;
      if (residual_ < 0.9 * gained_) gained_ = residual_, gained_at_ = iterations_;
      last_best_ = residual_;
    }
    return solved;
  }

  bool creeps() const {
    return iterations_ - gained_at_ > long_ && course_.size() > kMemory && course_.back() > kCreeps * course_.front();
  }

  /// A whole step, wherever it leads.
  bool leap() {
    course_.clear();
    factor_ = kAfterLeap;
    merit(lambda_);
    if (!direct()) return false;
    for (std::size_t i = 0; i < n_; ++i) lambda_[i] += direction(i);
    return true;
  }

  /// One regularised Newton step with its line search; false if no length served (λ is as before).
  bool step() {
    double now = merit(lambda_);
    const double before = now;
    if (!direct()) return false;
    const double length = search(now);
    if (length == 1.0 && is_held_back(alpha_, now, before))
      factor_ = kRelease * alpha_ / residual_;
    else if (length > 0.4)
      factor_ = std::max(0.5 * factor_, std::min(factor_, kLeastFactor));
    else if (length > 0.0 && length < 0.2)
      factor_ *= 2.0;
    return length > 0.0;
  }

  bool direct() {
    alpha_ = std::clamp(factor_ * residual_, kSmallest, kLargest);
    return find_direction(alpha_);
  }

  const int long_ = kLong + static_cast<int>(n_) / kLongPerContact;
  double alpha_ = 0.0, factor_ = kFirstFactor, last_best_ = INFINITY, gained_ = INFINITY;
  int best_at_ = 0, gained_at_ = 0;
};

class SemismoothNewton : public LcpSolver {
 public:
  int reference_rank() const override { return 1; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    if (!applies(problem).empty()) return {0, StopReason::refused};
    return Search(problem, settings, lambda).run();
  }
  std::string applies(const ConeProblem& problem) const override { return newton_applies(problem); }
};

}  // namespace

Entry<LcpSolver> semismooth_newton_solver() {
  return entry<LcpSolver, SemismoothNewton>(
      "semismooth_newton", "regularised Newton on Alart-Curnier's equations; quadratic near the solution");
}

}  // namespace impinge
