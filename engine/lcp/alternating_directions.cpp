// The alternating direction method of multipliers, ADMM [Tasora21], in the velocities of the bodies: in turn each contact
// is projected onto its cone, by itself, and all bodies are moved together by one sparse factorization of M + Jᵀ P J,
// which knows nothing of the contacts' number. P is a number a contact, κ over its W_ii. De Saxcé's shift is renewed in
// every iteration [DeSaxce98], so that what it ends at is Coulomb's law and not the associated one.
//
// κ decides how soon forces go through the whole: stacks and chains want much, tumbling piles little. It begins high and
// comes down where the residual doesn't. (To end where the lowest doesn't serve either leaves bridges of planks unsolved
// that it solves in time.)
#include "engine/lcp/alternating_directions.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>

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
        unit_weight_(n_),
        weight_(n_),
        y_(n_),
        w_(n_),
        z_(n_),
        u_(n_) {}

  LcpResult run() {
    if (measure(lambda_)) return finish(0, StopReason::converged);
    assemble();
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

  static Rows rows(const BodySpace::Side& side) {
    Rows j;
    j << side.linear, side.angular;
    return j;
  }

  /// M, and Jᵀ P J for κ = 1, lower triangles: what is factorized has one pattern for every κ.
  void assemble() {
    for (std::size_t i = 0; i < n_; ++i) {
      const Mat3& d = problem_.w->diagonal(i);
      const double scale = problem_.has_one_row(i) ? d(0, 0) : d.trace() / 3.0;
      unit_weight_[i] = scale > 0.0 ? 1.0 / scale : 0.0;
    }
    std::map<std::pair<int, int>, Matrix6> blocks;
    for (std::size_t i = 0; i < n_; ++i)
      for (const BodySpace::Side& a : bodies_.sides[i])
        for (const BodySpace::Side& b : bodies_.sides[i])
          if (b.body >= 0 && a.body >= b.body)
            blocks.try_emplace({a.body, b.body}, Matrix6::Zero()).first->second +=
                unit_weight_[i] * rows(a).transpose() * rows(b);
    std::vector<Eigen::Triplet<double>> own, together;
    const auto put = [](std::vector<Eigen::Triplet<double>>& entries, int row, int column, const Matrix6& block) {
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c)
          if (row != column || r >= c) entries.emplace_back(6 * row + r, 6 * column + c, block(r, c));
    };
    for (const auto& [place, block] : blocks) put(together, place.first, place.second, block);
    const int count = static_cast<int>(bodies_.mass.size());
    for (int b = 0; b < count; ++b) {
      Matrix6 m = Matrix6::Zero();
      m.topLeftCorner<3, 3>() = bodies_.mass[b] * Mat3::Identity();
      m.bottomRightCorner<3, 3>() = bodies_.inertia[b];
      put(own, b, b, m);
    }
    mass_.resize(6 * count, 6 * count), coupling_.resize(6 * count, 6 * count);
    mass_.setFromTriplets(own.begin(), own.end());
    coupling_.setFromTriplets(together.begin(), together.end());
    check_interrupt();
    factors_.analyzePattern(mass_ + coupling_);
  }

  /// P = κ / W_ii from here on.
  void weigh(double kappa) {
    check_interrupt();
    for (std::size_t i = 0; i < n_; ++i) weight_[i] = kappa * unit_weight_[i];
    factors_.factorize(mass_ + kappa * coupling_);
  }

  /// From λ, with the present weights.
  void start(const std::vector<Vec3>& lambda) {
    problem_.w->begin(lambda);
    velocities(problem_, u_);
    for (std::size_t i = 0; i < n_; ++i)
      y_[i] = weight_[i] > 0.0 ? Vec3(problem_.dual(i, u_[i]) - lambda[i] / weight_[i]) : Vec3(Vec3::Zero());
  }

  /// mᵀ x, as product() has m x.
  static Vec3 turned(const Mat3& m, const Vec3& x) {
    return {m(0, 0) * x.x() + m(1, 0) * x.y() + m(2, 0) * x.z(), m(0, 1) * x.x() + m(1, 1) * x.y() + m(2, 1) * x.z(),
            m(0, 2) * x.x() + m(1, 2) * x.y() + m(2, 2) * x.z()};
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
        pushed.segment<3>(6 * side.body) += turned(side.linear, push);
        pushed.segment<3>(6 * side.body + 3) += turned(side.angular, push);
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
  std::vector<double> unit_weight_, weight_;  // P for κ = 1, and P, kg
  std::vector<Vec3> y_, w_, z_;  // m/s: what is projected, its parts in the dual cone and, turned round, in the cone
  std::vector<Vec3> u_, best_;
  double residual_ = 0.0, best_residual_ = 0.0;
  Eigen::SparseMatrix<double> mass_, coupling_;
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
