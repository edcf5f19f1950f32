// Each outer step minimises, under the contacts' laws, a quadratic that lies above ½ Δv^T A Δv and touches it at a
// point y:
//   r = A y - J^T λ, Δv = y - Q⁻¹ r, Gauss-Seidel sweeps over the contacts on J Q⁻¹ J^T, which move Δv as they move λ,
// with Q of NodeInverse (Q >= A, checked along every step, since the power method only comes near λ_max from below).
//
// F = Δv - y is the gradient of ½ y^T A y - y^T J^T λ, preconditioned by Q and projected on the contacts that act:
// conjugate gradients can be had from it. The next y minimises that energy over y + span{F, last step of y}. While
// contacts stay open or closed this is the projected preconditioned conjugate gradient method; where one opens or
// closes, or F grows, it starts again with the plain step y = Δv. Where it makes no progress (stiff bodies that slide:
// Coulomb's law is not symmetric) the rest is done by Nesterov's rule, restarted where the step turns against it;
// without friction that is a majorise-minimise scheme on a convex problem. Two stacked 0.2 m cubes of 4³ and 3³ cells,
// mu 0.5, 90 frames of 4 sub-steps, E = 1e4 / 1e5 / 1e6: 16 / 19 / 4.7 s, Nesterov's rule alone 39 / 50 / 46 s,
// factorizations (constraint anticipation) 10 / 18 / 11 s. Where more rows meet than the surfaces have nodes, the
// sweeps carry impulse along the null space of J: see follow_drift; where that stalls W is written out and the cone solver
// asked, as constraint anticipation does; where contacts are few delassus_columns.cpp ends it, and what none of these solves
// augmented_lagrangian.cpp.
//
// With `factorizes` W is asked for also where that promises to be the quicker way (bodies are stiff or small), or has become
// it: dragons of 1e4 … 1e6 Pa take 14 times as long as with constraint anticipation without, and 1.1 times with it.
//
// The start is λ of the last sub-step and Δv = A⁻¹ J^T λ by conjugate gradients, as accurate as the contacts then hold:
// a resting group is recognized, and no work is spent on a λ that is far off.
#include "engine/response/accelerated_anticipation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/contact/friction_cone.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/response/augmented_lagrangian.hpp"
#include "engine/response/delassus_columns.hpp"
#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/delassus_of.hpp"
#include "engine/response/operators/factor_worth.hpp"
#include "engine/response/operators/splitting_delassus.hpp"

namespace impinge {
namespace {

constexpr int kSweeps = 4;        // a step at most; they start from the last step's λ
constexpr int kStartSteps = 400;  // of conjugate gradients at most
constexpr int kStartCheck = 8;    // steps between looks at what the contacts make of it
// of the contacts' residual: error of stiff bodies is far above D⁻¹ times their residual
constexpr double kStartAccuracy = 1e-3;
constexpr double kGrowth = 16.0;   // of |F|² over its least since the last restart, that asks for another
constexpr double kProgress = 0.5;  // of |F|², to count as progress
constexpr int kPatience = 50;      // steps without progress before conjugate gradients are given up
constexpr int kDrift = 10;         // steps in balance whose contacts don't hold, before λ is taken along its drift
// steps in which neither the balance nor the contacts get better by a half: more are no use. The more contacts, the
// dearer is what ends it
constexpr std::size_t kStalled = 100, kStalledOfContact = 2;
constexpr double kBetter = 0.5;
// contacts up to which W is written out then: what that and its solve take is known to be less than what is left here
constexpr std::size_t kMostDense = 1500;
constexpr int kMostIterations = 1000;  // of that solve
constexpr double kTimesLeast = 4.0;    // steps of this over what conjugate gradients take for A alone at least
constexpr int kFreshRigid = 32;        // steps after which rigid Δv is summed up afresh, lest rounding gathers

using Vectors = std::vector<VecX>;

double inner(const Vectors& a, const Vectors& b) {
  double sum = 0.0;
  for (std::size_t s = 0; s < a.size(); ++s) sum += dot(a[s], b[s]);
  return sum;
}

class AcceleratedSolver {
 public:
  AcceleratedSolver(GroupSystem& group, const ConeProblem& base, const LcpSolver& solver,
                    const AnticipationSettings& settings, const ResponseContext& context)
      : group_(group),
        base_(base),
        solver_(solver),
        settings_(settings),
        context_(context),
        by_change_(settings.stop == AnticipationSettings::Stop::change && !context.recovers_overlap),
        scale_(velocity_scale(base)),
        worth_(steps_worth()),
        start_(group.lambda) {}

  ResponseResult run() {
    ResponseResult result;
    const double tolerance = context_.lcp.tolerance * scale_;
    if (is_dear(0) && solve_by_w(result)) return result;
    prepare();
    start(tolerance);
    if (is_dear(0) && solve_by_w(result)) return result;
    for (const Vec3& lambda : group_.lambda) acts_.push_back(!lambda.isZero(0.0));
    double before = -1.0, momentum = momentum_residual();
    show();
    bool converged = momentum <= tolerance && rows_->natural_residual(group_.lambda, x_) <= tolerance;
    while (!converged && result.outer_iterations < settings_.max_iterations) {
      for (std::size_t s = 0; s < x_.size(); ++s) {
        std::swap(last_[s], x_[s]);
        std::swap(a_last_[s], a_x_[s]);
        r_[s] = a_y_[s] - f_[s];
        inverse_[s].step(y_[s], r_[s], x_[s]);
      }
      if (result.outer_iterations % kFreshRigid == 0) rows_->move_rigid(group_.lambda);
      earlier_ = group_.lambda;
      double change = 0.0;
      for (int k = 0; k < kSweeps; ++k) {
        check_interrupt();
        change = rows_->sweep(group_.lambda, x_);
        ++result.iterations;
        if (change <= 0.3 * tolerance || change <= 0.1 * momentum) break;
      }
      ++result.outer_iterations;
      const bool contacts_hold = change <= 2.0 * tolerance && rows_->natural_residual(group_.lambda, x_) <= tolerance;
      rows_->impulses(group_.lambda, f_);
      for (std::size_t s = 0; s < x_.size(); ++s) {
        multiply(*group_.deformable[s].a, x_[s], a_x_[s]);
      }
      momentum = momentum_residual();
      show();
      if (by_change_) {
        const double size = momentum_norm();
        converged = size == 0.0 || (before >= 0.0 && std::abs(size - before) < kSeedChange * before);
        before = size;
      } else {
        converged = contacts_hold && momentum <= tolerance;
      }
      if (converged) break;
      if (is_stalled(std::max(momentum, change), result.outer_iterations)) {
        result.ended = StopReason::stagnated;
        return by_change_ ? finish(result) : finish_otherwise(result, tolerance);
      }
      if (is_dear(result.outer_iterations) && solve_by_w(result)) return result;
      drifting_ = momentum <= std::max(tolerance, 0.1 * change) ? drifting_ + 1 : 0;
      if (drifting_ == kDrift) follow_drift();
      choose_next(result.outer_iterations);
    }
    if (!converged) result.ended = StopReason::iteration_cap, result.limit = settings_.limit;
    return finish(result);
  }

 private:
  /// What only the iteration needs.
  void prepare() {
    for (const DeformableBlock& block : group_.deformable) inverse_.emplace_back(block);
    rows_ = std::make_unique<SplittingDelassus>(group_, inverse_, base_.q);
    for (Vectors* v : {&x_, &last_, &y_, &a_x_, &a_last_, &a_y_, &f_, &r_, &step_, &d_, &a_d_})
      for (const DeformableBlock& block : group_.deformable) v->push_back(VecX::Zero(block.velocity.size()));
    rows_->move_rigid(group_.lambda);
    rows_->impulses(group_.lambda, f_);
  }

  ResponseResult finish(const ResponseResult& result) {
    rows_->move_rigid(group_.lambda);
    group_.deformable_delta = x_;
    return result;
  }

  /// By constraint anticipation, from where this began: λ of the sweeps is spread over many contacts, of which Newton's
  /// method drops few at a time.
  bool solve_by_w(ResponseResult& result) {
    if (has_w_failed_ || group_.contacts.size() > kMostDense) return false;
    const std::unique_ptr<Delassus> w = delassus_of(group_);
    ConeProblem problem = base_;
    problem.w = w.get();
    std::vector<Vec3> lambda = start_;
    LcpSettings settings = context_.lcp;
    settings.max_iterations = std::min(settings.max_iterations, kMostIterations);
    // not the one that was chosen for problems of another kind
    const LcpResult solve = make_named(lcp_solvers(), "automatic")->solve(problem, settings, lambda);
    result.iterations += solve.iterations;
    has_w_failed_ = !solve.solved();
    if (has_w_failed_) return false;
    group_.lambda = std::move(lambda);
    apply_impulses(group_);
    result.ended = StopReason::converged;
    if (context_.observe) context_.observe(group_);
    return true;
  }

  ResponseResult finish_otherwise(ResponseResult result, double tolerance) {
    if (rows_of(base_).size() > kFewRows && solve_by_w(result)) return result;
    finish(result);
    const GroupOperator a(group_);
    VecX x = a.load(group_);
    if (rows_of(base_).size() <= kFewRows) {
      const DelassusColumnsResult columns = solve_by_delassus_columns(a, base_, solver_, tolerance, group_, x);
      result.iterations += columns.iterations;
      result.outer_iterations += columns.solves;
      if (columns.converged) {
        result.ended = StopReason::converged;
        return store(result, a, x);
      }
    }
    const AugmentedLagrangianResult rest = solve_by_augmented_lagrangian(a, base_, tolerance, group_, x);
    result.iterations += rest.newton_steps;
    result.outer_iterations += rest.multiplier_steps;
    result.ended = rest.converged ? StopReason::converged : StopReason::stagnated;
    return store(result, a, x);
  }

  ResponseResult store(ResponseResult result, const GroupOperator& a, const VecX& x) {
    a.store(x, group_);
    if (context_.observe) context_.observe(group_);
    return result;
  }

  /// Steps that may be made before constraint anticipation is the quicker one; 0 where that is from the start, none where
  /// it can't take over.
  std::optional<double> steps_worth() const {
    if (!settings_.factorizes || by_change_ || group_.contacts.size() > kMostDense) return std::nullopt;
    const std::optional<FactorWorth> worth = factor_worth(group_);
    if (!worth) return std::nullopt;
    return kTimesLeast * worth->at_least < worth->steps ? worth->steps : 0.0;
  }

  /// x = y = A⁻¹ J^T λ, nearly.
  void start(double tolerance) {
    if (momentum_norm() == 0.0) return;
    Vectors direction = x_, a_direction = x_;
    double rho = 0.0;
    for (int k = 0; k < kStartSteps; ++k, ++start_steps_) {
      check_interrupt();
      for (std::size_t s = 0; s < x_.size(); ++s) {  // step_ = Q⁻¹ (f - A x)
        r_[s] = a_x_[s] - f_[s];
        inverse_[s].step(last_[s], r_[s], step_[s]);
      }
      const double next = -inner(step_, r_), beta = k > 0 ? next / rho : 0.0;
      rho = next;
      for (std::size_t s = 0; s < x_.size(); ++s) {
        direction[s] = step_[s] + beta * direction[s];
        multiply(*group_.deformable[s].a, direction[s], a_direction[s]);
      }
      const double curvature = inner(direction, a_direction);
      if (!(curvature > 0.0)) break;
      for (std::size_t s = 0; s < x_.size(); ++s) {
        x_[s] += rho / curvature * direction[s];
        a_x_[s] += rho / curvature * a_direction[s];
      }
      if (is_dear(0)) break;
      if (k % kStartCheck == kStartCheck - 1 &&
          momentum_residual() <= std::max(0.3 * tolerance, kStartAccuracy * rows_->natural_residual(group_.lambda, x_)))
        break;
    }
    y_ = x_;
    a_y_ = a_x_;
  }

  void show() {
    if (!context_.observe) return;
    group_.deformable_delta = x_;
    context_.observe(group_);
  }

  bool is_dear(int steps) const { return worth_ && !has_w_failed_ && start_steps_ + steps >= *worth_; }

  bool is_stalled(double error, int iteration) {
    if (least_error_ < 0.0 || error < kBetter * least_error_) {
      least_error_ = error;
      least_error_at_ = iteration;
    }
    const std::size_t patience = std::max(kStalled, group_.contacts.size() / kStalledOfContact);
    return iteration - least_error_at_ > static_cast<int>(patience);
  }

  /// Two contacts in nearly one place with bounds that differ a little: every sweep moves the same bit of impulse from
  /// the one to the other, the bodies feel nothing, and it takes a million sweeps until the second is empty. All of it
  /// at once: λ along its last change until the first contact opens.
  void follow_drift() {
    drifting_ = 0;
    double longest = 0.0;
    for (std::size_t i = 0; i < earlier_.size(); ++i) {
      const double now = group_.lambda[i].x(), change = now - earlier_[i].x();
      if (change < 0.0 && now > 0.0 && (longest == 0.0 || now < -longest * change)) longest = now / -change;
    }
    for (std::size_t i = 0; i < earlier_.size(); ++i) {
      group_.lambda[i] += longest * (group_.lambda[i] - earlier_[i]);
      if (group_.contacts[i].kind == RowKind::contact)
        group_.lambda[i] = project_to_cone(group_.lambda[i], group_.contacts[i].friction);
    }
    rows_->move_rigid(group_.lambda);
    rows_->impulses(group_.lambda, f_);
  }

  /// Inner products of F = x - y and d, the last step of y. Q F = J^T λ - A y, A F = A x - A y.
  struct Gram {
    double f_q_f = 0.0, f_a_f = 0.0, d_q_f = 0.0, f_a_d = 0.0, d_a_d = 0.0;
    double turn = 0.0;    // of the step against the last change of x, in the norm of Q
    bool shrunk = false;  // Q was below A along the step, and has been made larger
  };

  Gram measure_step() {
    Gram g;
    for (std::size_t s = 0; s < x_.size(); ++s) {
      step_[s] = x_[s] - y_[s];
      r_[s] = a_y_[s] - f_[s];  // -Q F
      const double q_norm = -dot(step_[s], r_[s]), a_norm = dot(step_[s], a_x_[s]) - dot(step_[s], a_y_[s]);
      if (a_norm > 1.001 * q_norm && q_norm > 1e-20 * dot(x_[s], a_x_[s])) {
        inverse_[s].shrink(1.05 * a_norm / q_norm);
        g.shrunk = true;
      }
      g.f_q_f += q_norm;
      g.f_a_f += a_norm;
      g.d_q_f -= dot(d_[s], r_[s]);
      g.f_a_d += dot(step_[s], a_d_[s]);
      g.d_a_d += dot(d_[s], a_d_[s]);
      g.turn += dot(r_[s], x_[s]) - dot(r_[s], last_[s]);
    }
    if (g.shrunk) rows_->prepare();
    return g;
  }

  void choose_next(int iteration) {
    const Gram g = measure_step();
    if (best_ < 0.0 || g.f_q_f < kProgress * best_) {
      best_ = g.f_q_f;
      best_at_ = iteration;
    }
    if (cautious_)
      extrapolate(g);
    else
      minimise(g, iteration);
  }

  /// y = the minimum over y + span{F, d}, or x where that is not to be trusted.
  void minimise(const Gram& g, int iteration) {
    cautious_ = iteration - best_at_ > kPatience;
    bool restart = cautious_ || g.shrunk || iteration == 1 || !(g.f_q_f <= kGrowth * least_);
    for (std::size_t i = 0; i < acts_.size(); ++i) {
      const char now = !group_.lambda[i].isZero(0.0);
      restart |= now != acts_[i];
      acts_[i] = now;
    }
    least_ = restart ? g.f_q_f : std::min(least_, g.f_q_f);
    if (restart) {
      for (std::size_t s = 0; s < x_.size(); ++s) {
        d_[s].setZero();
        a_d_[s].setZero();
        y_[s] = x_[s];
        a_y_[s] = a_x_[s];
      }
      return;
    }
    double alpha = g.f_a_f > 0.0 ? g.f_q_f / g.f_a_f : 1.0, beta = 0.0;
    const double determinant = g.f_a_f * g.d_a_d - g.f_a_d * g.f_a_d;
    if (g.d_a_d > 0.0 && determinant > 1e-14 * g.f_a_f * g.d_a_d) {
      alpha = (g.f_q_f * g.d_a_d - g.d_q_f * g.f_a_d) / determinant;
      beta = (g.d_q_f * g.f_a_f - g.f_q_f * g.f_a_d) / determinant;
    }
    for (std::size_t s = 0; s < x_.size(); ++s) {
      d_[s] = alpha * step_[s] + beta * d_[s];
      a_d_[s] = alpha * (a_x_[s] - a_y_[s]) + beta * a_d_[s];
      y_[s] += d_[s];
      a_y_[s] += a_d_[s];
    }
  }

  /// Nesterov's rule.
  void extrapolate(const Gram& g) {
    const bool restart = g.turn > 0.0;
    if (restart) theta_ = 1.0;
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * theta_ * theta_));
    const double beta = restart ? 0.0 : (theta_ - 1.0) / next;
    for (std::size_t s = 0; s < x_.size(); ++s) {
      y_[s] = x_[s] + beta * (x_[s] - last_[s]);
      a_y_[s] = a_x_[s] + beta * (a_x_[s] - a_last_[s]);
    }
    theta_ = next;
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
  const ConeProblem& base_;
  const LcpSolver& solver_;
  const AnticipationSettings& settings_;
  const ResponseContext& context_;
  const bool by_change_;               // stops by the seed's rule
  const double scale_;                 // m/s, what residuals are relative to
  const std::optional<double> worth_;  // steps, as steps_worth() has it
  const std::vector<Vec3> start_;      // λ as it came
  std::vector<NodeInverse> inverse_;
  std::unique_ptr<SplittingDelassus> rows_;
  Vectors x_, last_, y_, a_x_, a_last_, a_y_, f_, r_, step_;
  Vectors d_, a_d_;            // last step of y, and A times it
  std::vector<Vec3> earlier_;  // λ before the last sweeps
  int drifting_ = 0, start_steps_ = 0;
  bool has_w_failed_ = false;
  std::vector<char> acts_;     // contacts with an impulse
  double least_ = 0.0;         // |F|² since the last restart
  double least_error_ = -1.0;  // of balance and contacts, m/s, and when it was last bettered
  int least_error_at_ = 0;
  double best_ = -1.0;  // |F|² of the whole solve, and when it was last bettered
  int best_at_ = 0;
  bool cautious_ = false;  // conjugate gradients were given up
  double theta_ = 1.0;
};

}  // namespace

ResponseResult solve_accelerated(GroupSystem& group, const ConeProblem& base, const LcpSolver& solver,
                                 const AnticipationSettings& settings, const ResponseContext& context) {
  return AcceleratedSolver(group, base, solver, settings, context).run();
}

}  // namespace impinge
