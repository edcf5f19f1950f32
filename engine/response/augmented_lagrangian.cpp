// Sweeps carry impulse along the null space of J where more rows meet than the surfaces have unknowns, and with sliding
// friction they need not come to an end. Here redundancy is harmless: the multipliers stay where they were, and what is
// solved for is the velocity, of which there is one,
//   A Δv = J^T P(λ - ρ u),   u = J Δv + q,   P of Alart and Curnier: λ_n >= 0, |λ_t| <= mu λ_n,
// springs of stiffness ρ over the impulses that are known; then λ <- P(λ - ρ u) [Hestenes69, Powell69; SimoLaursen92].
// Where λ stands still the law holds exactly, Coulomb's cone. The springs are solved by Newton's method: Δv steps by (A
// + J^T G J)⁻¹ of what is left, G = ρ dP, which is not symmetric where something slides. A⁻¹ is never asked for.
//
// ρ begins at kSoft times what D lets a contact feel, and rises while rounds gain too little: a round shrinks the part
// of the error along an eigenvector of W by 1/(1 + ρ eigenvalue), and hundreds of contacts on a few soft elements have
// small ones. Above kStiffest Newton's steps fail. A dragon of 1e4 Pa in 1,170 contacts, whose sweeps stall at 1e-4:
// 1e-8 in 3 to 7 s.
#include "engine/response/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/alart_curnier.hpp"
#include "engine/lcp/residual.hpp"

namespace impinge {
namespace {

constexpr double kSoft = 100.0, kStiffest = 1e4, kRise = 4.0;
constexpr double kGain = 0.3;  // of the error after a round, to leave ρ as it is
constexpr int kMultiplierSteps = 60, kNewtonSteps = 40;
constexpr double kSteady = 0.2;  // how little the gain of two rounds differs for the next to be had at once
constexpr double kWorse = 10.0;  // times the error: the round is taken back
constexpr int kStepHalvings = 8;
constexpr double kInner = 1e-2;  // of a Newton step's system
constexpr double kPart = 0.1;    // of the contacts' error: how well the springs are solved in a round

class AugmentedSolver {
 public:
  AugmentedSolver(const GroupOperator& a, const ConeProblem& problem, GroupSystem& group, VecX& x)
      : a_(a),
        problem_(problem),
        group_(group),
        x_(x),
        ax_(a.multiply(x)),
        u_(problem.q.size()),
        next_(u_.size()),
        g_(u_.size()) {
    for (std::size_t i = 0; i < u_.size(); ++i) {
      mobility_.push_back(a.block_mobility(i));
      const auto inverse = [](double w) { return w > 0.0 ? kSoft / w : 0.0; };
      rho_.emplace_back(inverse(mobility_[i](0, 0)),
                        problem.has_one_row(i) ? 0.0 : inverse(0.5 * (mobility_[i](1, 1) + mobility_[i](2, 2))));
      u_[i] = a.row(i, x) + problem.q[i];
    }
  }

  AugmentedLagrangianResult run(double tolerance) {
    AugmentedLagrangianResult result;
    double stiffest = kStiffest;
    State best = state(), last = best;
    while (true) {
      result.converged = last.error() <= tolerance;
      if (result.converged || result.multiplier_steps == kMultiplierSteps) break;
      check_interrupt();
      if (!last.along.empty()) follow(last);
      ++result.multiplier_steps;
      const bool solved = solve_springs(std::max(0.3 * tolerance, kPart * last.contacts), result.newton_steps);
      group_.lambda = next_;
      State now = state();
      const bool worse = !(now.error() < kWorse * last.error());
      if (!solved || worse) {
        stiffest = stiffness_ / kRise;
        scale(1.0 / kRise);
      } else {
        now.gain = now.contacts / last.contacts;
        if (now.gain > kGain && stiffness_ * kRise <= stiffest)
          scale(kRise);
        else if (std::abs(now.gain - last.gain) < kSteady * (1.0 - now.gain))
          now.set_along(last);
      }
      if (worse)
        restore(last);
      else
        last = std::move(now);
      if (last.error() < best.error()) best = last;
    }
    if (!result.converged) restore(best);
    return result;
  }

 private:
  struct State {
    VecX x, ax;
    std::vector<Vec3> lambda, u;
    double contacts = 0.0, momentum = 0.0;  // what is left, m/s
    double gain = 0.0;                      // contacts over those of the round before
    std::vector<Vec3> along;                // change of λ, if the rounds follow one direction

    double error() const { return std::max(contacts, momentum); }
    void set_along(const State& before) {
      for (std::size_t i = 0; i < lambda.size(); ++i) along.push_back(lambda[i] - before.lambda[i]);
    }
  };

  State state() const {
    return {x_, ax_, group_.lambda, u_, natural_residual(), a_.velocity_of(impulse(group_.lambda) - ax_), 0.0, {}};
  }

  void restore(const State& s) {
    x_ = s.x;
    ax_ = s.ax;
    group_.lambda = s.lambda;
    u_ = s.u;
  }

  /// All that is left lies along one eigenvector: the rounds to come, summed.
  void follow(State& s) {
    for (std::size_t i = 0; i < u_.size(); ++i)
      group_.lambda[i] = problem_.nearest(i, s.lambda[i] + s.gain / (1.0 - s.gain) * s.along[i]);
    s.along.clear();
    s.gain = 0.0;
  }

  void scale(double factor) {
    stiffness_ *= factor;
    for (Vec2& rho : rho_) rho *= factor;
  }

  VecX impulse(const std::vector<Vec3>& lambda) const {
    VecX f = VecX::Zero(a_.size());
    for (std::size_t i = 0; i < lambda.size(); ++i) a_.add_impulse(i, lambda[i], f);
    return f;
  }

  double natural_residual() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < u_.size(); ++i)
      worst = std::max(worst, natural_map(problem_.kind_of(i), mobility_[i], u_[i], group_.lambda[i], problem_.mu[i]));
    return worst;
  }

  /// next = P(λ - ρ u); returns J^T next - A Δv.
  VecX left(const std::vector<Vec3>& u, const VecX& ax) {
    for (std::size_t i = 0; i < u.size(); ++i)
      next_[i] = group_.lambda[i] - alart_curnier_value(problem_, i, u[i], group_.lambda[i], rho_[i]);
    return impulse(next_) - ax;
  }

  /// Δv for which the springs are in balance to `goal`, m/s. False if Newton's method didn't get there.
  bool solve_springs(double goal, int& steps) {
    VecX r = left(u_, ax_);
    double size = a_.norm(r);
    for (int k = 0; k < kNewtonSteps && a_.velocity_of(r) > goal; ++k, ++steps) {
      for (std::size_t i = 0; i < u_.size(); ++i)
        g_[i] = alart_curnier(problem_, i, u_[i], group_.lambda[i], rho_[i]).by_u;
      VecX p = VecX::Zero(a_.size());
      a_.solve_unsymmetric(g_, r, kInner, p);
      const VecX ap = a_.multiply(p);
      std::vector<Vec3> along(u_.size()), u(u_.size());
      for (std::size_t i = 0; i < u_.size(); ++i) along[i] = a_.row(i, p);
      double length = 1.0;
      for (int h = 0;; ++h, length *= 0.5) {
        for (std::size_t i = 0; i < u_.size(); ++i) u[i] = u_[i] + length * along[i];
        r = left(u, ax_ + length * ap);
        if (a_.norm(r) <= (1.0 - 0.1 * length) * size || h == kStepHalvings) break;
      }
      x_ += length * p;
      ax_ += length * ap;
      u_ = u;
      size = a_.norm(r);
    }
    return a_.velocity_of(r) <= goal;
  }

  const GroupOperator& a_;
  const ConeProblem& problem_;
  GroupSystem& group_;
  VecX& x_;
  VecX ax_;
  std::vector<Vec3> u_, next_;
  std::vector<Mat3> g_, mobility_;
  std::vector<Vec2> rho_;
  double stiffness_ = kSoft;  // of ρ
};

}  // namespace

AugmentedLagrangianResult solve_by_augmented_lagrangian(const GroupOperator& a, const ConeProblem& problem,
                                                        double tolerance, GroupSystem& group, VecX& x) {
  return AugmentedSolver(a, problem, group, x).run(tolerance);
}

}  // namespace impinge
