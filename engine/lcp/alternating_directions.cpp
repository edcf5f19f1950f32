// The alternating direction method of multipliers, ADMM [Tasora21], in the velocities of the bodies: in turn each contact
// is projected onto its cone, by itself, and all bodies are moved together by one sparse factorization of M + Jᵀ P J,
// which knows nothing of the contacts' number. P is a number a contact, κ over its W_ii. De Saxcé's shift is renewed in
// every iteration [DeSaxce98], so that what it ends at is Coulomb's law and not the associated one.
//
// κ decides how soon forces go through the whole: stacks and chains want much, tumbling piles little. It begins high and
// comes down where the residual doesn't.
#include "engine/lcp/alternating_directions.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/body_space.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr double kRelaxation = 1.6;
constexpr double kWeights[] = {1000.0, 100.0, 10.0};  // κ, in this order
constexpr int kLook = 10;                             // iterations from one residual to the next
constexpr int kPatience = 60;  // iterations in which a weight that serves lowers the residual by kServes
constexpr double kServes = 0.5;
constexpr double kWarm = 0.1;  // a λ that is farther off is worse than none, whose residual is at most 1

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Rows = Eigen::Matrix<double, 3, 6>;

class Iteration {
 public:
  Iteration(const ConeProblem& problem, const BodySpace& bodies, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : problem_(problem),
        bodies_(bodies),
        settings_(settings),
        lambda_(lambda),
        n_(lambda.size()),
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
    start(kWeights[level], is_cold ? nothing : best_);
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
        start(kWeights[level], nothing);
      } else if (level + 1 < std::size(kWeights)) {
        start(kWeights[++level], best_);
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

  /// From λ with the weights κ / W_ii.
  void start(double kappa, const std::vector<Vec3>& lambda) {
    for (std::size_t i = 0; i < n_; ++i) {
      const Mat3& d = problem_.w->diagonal(i);
      const double scale = problem_.has_one_row(i) ? d(0, 0) : d.trace() / 3.0;
      weight_[i] = scale > 0.0 ? kappa / scale : 0.0;
    }
    factorize();
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    for (std::size_t i = 0; i < n_; ++i)
      y_[i] = weight_[i] > 0.0 ? Vec3(problem_.dual(i, u_[i]) - lambda[i] / weight_[i]) : Vec3(Vec3::Zero());
  }

  static Rows rows(const BodySpace::Side& side) {
    Rows j;
    j << side.linear, side.angular;
    return j;
  }

  void factorize() {
    const auto count = bodies_.mass.size();
    struct Part {
      int row, column;
      std::size_t contact;
      int first, second;  // sides
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < n_; ++i)
      for (int s = 0; s < 2; ++s)
        for (int t = 0; t < 2; ++t) {
          const int a = bodies_.sides[i][s].body, b = bodies_.sides[i][t].body;
          if (a >= 0 && b >= 0 && a >= b) parts.push_back({a, b, i, s, t});
        }
    std::stable_sort(parts.begin(), parts.end(), [](const Part& l, const Part& r) {
      return std::pair(l.row, l.column) < std::pair(r.row, r.column);
    });
    std::vector<Eigen::Triplet<double>> entries;
    const auto put = [&](int row, int column, const Matrix6& block) {
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c)
          if (row != column || r >= c) entries.emplace_back(6 * row + r, 6 * column + c, block(r, c));
    };
    for (std::size_t b = 0; b < count; ++b) {
      Matrix6 m = Matrix6::Zero();
      m.topLeftCorner<3, 3>() = bodies_.mass[b] * Mat3::Identity();
      m.bottomRightCorner<3, 3>() = bodies_.inertia[b];
      put(static_cast<int>(b), static_cast<int>(b), m);
    }
    for (std::size_t i = 0; i < parts.size();) {
      const Part& first = parts[i];
      Matrix6 sum = Matrix6::Zero();
      for (; i < parts.size() && parts[i].row == first.row && parts[i].column == first.column; ++i) {
        const auto& sides = bodies_.sides[parts[i].contact];
        sum += weight_[parts[i].contact] * rows(sides[parts[i].first]).transpose() * rows(sides[parts[i].second]);
      }
      put(first.row, first.column, sum);
    }
    const auto size = static_cast<Eigen::Index>(6 * count);
    Eigen::SparseMatrix<double> m(size, size);
    m.setFromTriplets(entries.begin(), entries.end());
    check_interrupt();
    factors_.compute(m);
  }

  void step() {
    VecX pushed = VecX::Zero(static_cast<Eigen::Index>(6 * bodies_.mass.size()));
    for (std::size_t i = 0; i < n_; ++i) {
      z_[i] = problem_.nearest(i, -y_[i]);
      w_[i] = y_[i] + z_[i];
      Vec3 wanted = w_[i];
      if (problem_.kind_of(i) == RowKind::contact && problem_.mu[i] > 0.0)
        wanted.x() -= problem_.mu[i] * std::hypot(w_[i].y(), w_[i].z());
      const Vec3 push = weight_[i] * (z_[i] + wanted - problem_.q[i]);
      for (const BodySpace::Side& side : bodies_.sides[i]) {
        if (side.body < 0) continue;
        pushed.segment<3>(6 * side.body) += side.linear.transpose() * push;
        pushed.segment<3>(6 * side.body + 3) += side.angular.transpose() * push;
      }
    }
    const VecX v = factors_.solve(pushed);
    for (std::size_t i = 0; i < n_; ++i) {
      if (weight_[i] == 0.0) continue;
      Vec3 u = problem_.q[i];
      for (const BodySpace::Side& side : bodies_.sides[i])
        if (side.body >= 0)
          u += product(side.linear, v.segment<3>(6 * side.body)) +
               product(side.angular, v.segment<3>(6 * side.body + 3));
      y_[i] = kRelaxation * problem_.dual(i, u) + (1.0 - kRelaxation) * w_[i] - z_[i];
    }
  }

  const ConeProblem& problem_;
  const BodySpace& bodies_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  std::vector<double> weight_;   // P, kg
  std::vector<Vec3> y_, w_, z_;  // m/s: what is projected, its parts in the dual cone and, turned round, in the cone
  std::vector<Vec3> u_, best_;
  double residual_ = 0.0, best_residual_ = 0.0;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors_;
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
