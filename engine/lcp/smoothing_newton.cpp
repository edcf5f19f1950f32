// Newton's method on rounded equations whose width falls to nothing, with a compliance that falls beside it: smoothing
// and regularization combined [Hayashi05], here on Alart and Curnier's equations of Coulomb's law. In a large heap
// thousands of contacts are on their kinks at once, and Newton on the exact equations changes few of them with a step;
// rounded ones are passed together. A width is kept until F is small beside it, or for some steps; the last one is 0.
//
// Coulomb's law is not monotone: the answers' path over the width may end, and go on elsewhere. So what is left after
// some steps is taken to the next width all the same.
#include <algorithm>
#include <cmath>

#include "engine/lcp/newton_search.hpp"

namespace impinge {
namespace {

constexpr double kFirstWidth = 0.1;     // over the velocities of the problem
constexpr double kFall = 0.3;           // from one width to the next
constexpr double kLast = 0.1;           // of the tolerance: the last width before 0
constexpr double kStiffness = 1e5;      // width over compliance
constexpr double kNear = 0.1;           // F, root mean square, over the width: go on with the next
constexpr double kExact = 0.01;         // of the tolerance: F is as good as 0
constexpr int kStepsAtWidth = 15;       // at one width
constexpr double kFirstDamping = 1e-3;  // α over F at each width
constexpr double kFromNear = 30.0;      // the first width over the residual, where that is less
constexpr int kSweepsBefore = 3;

class Continuation : NewtonSearch {
 public:
  Continuation(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : NewtonSearch(problem, settings, lambda), velocity_(velocity_scale(problem)) {}

  LcpResult run() {
    if (measure()) return finish(StopReason::converged);
    const int first = problem_.w->has_factors() ? kSweepsBefore : 0;
    while (iterations_ < std::min(first, settings_.max_iterations))
      if (sweep()) return finish(StopReason::converged);
    for (double width = std::min(kFirstWidth, kFromNear * residual_); width > 0.0; width *= kFall) {
      if (width < kLast * settings_.tolerance) width = 0.0;
      if (!go_on(width)) continue;
      if (measure()) return finish(StopReason::converged);
      if (iterations_ >= settings_.max_iterations) return finish(StopReason::iteration_cap);
    }
    return finish(StopReason::stagnated);
  }

 private:
  /// Newton's steps with one width, relative to the problem's velocities; whether any was made.
  bool go_on(double width) {
    soften(width * velocity_, width / kStiffness);
    course_.clear();
    double factor = kFirstDamping, now = merit(lambda_);
    const int before = iterations_;
    for (int k = 0; k < kStepsAtWidth && iterations_ < settings_.max_iterations; ++k, ++iterations_) {
      const double left = std::sqrt(now / static_cast<double>(n_)) / velocity_;
      if (!(left > std::max(kNear * width, kExact * settings_.tolerance))) break;
      const double alpha = std::clamp(factor * left, kSmallest, kLargest);
      const double length = find_direction(alpha) ? search(now) : 0.0;
      if (length == 0.0 && alpha == kLargest) break;
      if (length == 0.0)
        factor *= 10.0;
      else if (length < 0.2)
        factor *= 2.0;
      else if (length > 0.4)
        factor = std::max(0.5 * factor, kFirstDamping);
      if (k > 0) note(residual_);
    }
    soften(0.0, 0.0);
    return iterations_ > before;
  }

  const double velocity_;
};

class SmoothingNewton : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    if (!applies(problem).empty()) return {0, StopReason::refused};
    return Continuation(problem, settings, lambda).run();
  }
  std::string applies(const ConeProblem& problem) const override { return newton_applies(problem); }
};

}  // namespace

Entry<LcpSolver> smoothing_newton_solver() {
  return entry<LcpSolver, SmoothingNewton>("smoothing_newton",
                                           "Newton on rounded equations whose rounding falls to nothing; large heaps");
}

}  // namespace impinge
