// Sweeps where they are quick, Newton where they are not. Gauss-Seidel begins, from the last sub-step's λ; once its
// rate is known, what it still needs is compared with the price of Newton's factorizations. Counts decide, never
// clocks, so the same problem takes the same way everywhere.
//
// Price in sweeps: where all bodies are rigid Newton's systems have six rows a body, and a solve costs some twenty
// sweeps however many contacts there are. Where W is dense a step of Newton's costs what the contacts that carry make it
// or the nodes make it (of_step), and from a λ that is near five of them do, else some twelve: 16 frozen groups of deformable
// bodies and 5 published problems took 5 to 94 sweeps a step, 207 the largest, where 11 to 160 are expected. There Newton
// begins with the λ that came, not with that of the sweeps: on frozen steps of two soft cubes in 130 to 530 contacts it
// took half the time (5.9 s of 11.9 in all). With more contacts than kMostDense (a W with factors, whose sweeps cost n:
// kMostFactored) the sweeps are made conjugate instead.
//
// Between the two, where W is dense: where Gauss-Seidel would need N sweeps, conjugate ones (kConjugateSweep times as
// dear) needed 4 to 10 roots of N on published problems and frozen steps of deformable bodies (N 120 to 3,300). They are
// tried where that is less than Newton's price, and left where their rate doesn't keep it.
//
// Rigid bodies without friction are a quadratic program, which the dual active set answers exactly in some pivots more than
// contacts carry (2,217 frozen groups of 78 to 187 contacts in a chain of links: 0.4 ms each, where Newton took 26). Pivots
// are counted kPivotsOfIteration together: with as many of them as others have iterations a roller chain of a hundred links
// had solves without an answer.
//
// With friction rigid bodies in many contacts first come to kEnough. A λ that comes from the step before is brought there by alternating
// directions (ADMM), whose iterations cost a thirtieth of Newton's steps in a heap of a thousand boxes; where they creep,
// which they do as the heap comes to rest, they go on from the answer of widely rounded equations (smoothing_newton.cpp), which
// has forces right throughout and single contacts wrong, so that some 50 iterations end it. From nothing it is Newton that
// finds what a wall carries. From there on Newton, then rounded equations have the steps that bring digits, which they do at
// once in what stands, and what comes to rest needs: with 1e-3 it trembles. What they leave is handed on as it is, not
// converged: in a heap that tumbles the rest takes minutes a frame and moves nothing that can be seen, and they are left after
// kFewest steps. Where no more than kFewDigits are asked for, alternating directions begin with kSome contacts already.
//
// With fewer contacts Newton needs fewer steps than rounded equations as a rule, and many more where it wanders: after
// kNewtonSteps of them (of kSome contacts and more in motion as soon as they bring no digits: 29 of 53 frozen steps of a heap
// had 150 in vain) rounded equations are tried from where it began, then Newton again from the better of the two, and
// from nothing; what it leaves then goes to conjugate sweeps, and what they leave far from an answer to rounded
// equations, and from there to Newton again. With kMany contacts that takes seconds, and what is within kNearEnough once both
// have had their turn is handed on: in a wall that a ball goes through nothing brings more digits, or hundreds of steps
// each.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/lcp/alternating_directions.hpp"
#include "engine/lcp/conjugate_sweeps.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"
#include "engine/lcp/node_space.hpp"

namespace impinge {

Entry<LcpSolver> dual_active_set_solver();
Entry<LcpSolver> nonsmooth_nonlinear_conjugate_gradient_solver();
Entry<LcpSolver> semismooth_newton_solver();
Entry<LcpSolver> smoothing_newton_solver();

namespace {

constexpr int kFirstSweeps = 30;  // before the rate is looked at
constexpr int kFewSweeps = 10;    // the same where Newton is quick, or a W that is dense makes sweeps dear
constexpr int kWindow = 10;       // of them that it is taken over
constexpr double kGood = 0.1;     // a relative residual that Newton may begin with
constexpr double kSteps = 12.0, kStepsFromNear = 5.0;                  // of Newton's from anywhere, and from there
constexpr double kSweepsOfStep = 10.0, kOfRows = 0.6, kOfNodes = 0.1;  // the price of one of them, where W is dense
constexpr double kConjugateSweep = 1.45;                               // what a conjugate sweep costs, in sweeps
constexpr double kConjugateOfRoot = 6.0;  // how many of them are expected, over the root of the others' number
constexpr std::size_t kConjugateWindow = 20;
constexpr double kTooFar = 2.0;  // prices of Newton's where they are left whatever they promise
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostDense = 1500, kMostFactored = 300;
constexpr double kSweepsPerContact = 2.0;    // the price of Newton's method, where W has factors
constexpr double kSweepsOfBodies = 20.0;     // and where all bodies are rigid
constexpr double kSweepsOfConjugate = 50.0;  // what conjugate sweeps cost beside what they save
constexpr std::size_t kMostActive = 3000;    // contacts
constexpr int kPivotsOfContact = 20;         // at most
constexpr int kPivotsOfIteration = 50;       // which cost about as much as a step of Newton's
constexpr std::size_t kLarge = 1500;  // contacts of rigid bodies with which Newton finds no answer that is far off
constexpr std::size_t kMany = 500;    // with which its steps are dear
constexpr std::size_t kSome = 300;    // with which a few digits come sooner by alternating directions
constexpr double kFewDigits = 5e-4;   // a tolerance that asks for no more
constexpr int kFewSteps = 20;         // of it there, and again as long as they leave less than kGain
constexpr int kFewest = 8;            // the same of what is in motion, from an answer within kEnough
constexpr double kGain = 0.3;
constexpr double kEnough = 1e-3;   // a relative residual
constexpr double kInReach = 1e-2;  // one from which alternating directions find it soon
constexpr double kAlmost = 5e-5;   // one that rounded equations bring to the last digits soon, if Newton doesn't
constexpr int kSomeSteps = 40;     // of rounded equations, likewise
constexpr int kRounds = 2;  // of rounded equations, of conjugate sweeps, which end what those creep at, and Newton
constexpr int kLastDigits = 100;   // sweeps
constexpr int kMoreSteps = 300;    // of Newton's
constexpr int kNewtonSteps = 150;  // of them, with fewer contacts
constexpr int kConjugate = 300;    // sweeps, where all else has ended
constexpr int kAny = std::numeric_limits<int>::max();
constexpr double kFarBetter = 0.1;    // where there is no answer nothing at all may pass for a little better than most
constexpr double kNearEnough = 1e-5;  // a relative residual that another method betters seldom

using Solve = LcpResult(const ConeProblem&, const LcpSettings&, std::vector<Vec3>&);

template <Entry<LcpSolver> (*Method)()>
LcpResult by(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) {
  return Method().make()->solve(problem, settings, lambda);
}

constexpr Solve* kNewton = by<semismooth_newton_solver>;
constexpr Solve* kRounded = by<smoothing_newton_solver>;
constexpr Solve* kActiveSet = by<dual_active_set_solver>;
constexpr Solve* kConjugateSweeps = by<nonsmooth_nonlinear_conjugate_gradient_solver>;

class Automatic : public LcpSolver {
 public:
  bool chooses_by_problem() const override { return true; }
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    const std::size_t n = lambda.size();
    const bool bodies = problem.w->body_space() != nullptr;
    const NodeSpace* nodes = problem.w->node_space();
    const bool newton = bodies || nodes != nullptr || n <= (problem.w->has_factors() ? kMostFactored : kMostDense);
    const bool dense = !problem.w->has_factors();
    double price = bodies ? kSweepsOfBodies : newton ? kSweepsPerContact * static_cast<double>(n) : kSweepsOfConjugate;
    const int first = bodies || dense ? kFewSweeps : kFirstSweeps;
    SweepStop stop(problem, settings);
    problem.w->begin(lambda);
    if (stop.solved(lambda)) return {0, StopReason::converged};
    const bool is_cold = is_zero(lambda);
    const double steps = stop.residual() < kGood && !is_cold ? kStepsFromNear : kSteps;
    const double goal = settings.tolerance * velocity_scale(problem);
    std::vector<double> changes;
    const std::vector<Vec3> start = dense && newton ? lambda : std::vector<Vec3>();
    for (int sweep = 1; sweep <= settings.max_iterations; ++sweep) {
      const double change = gauss_seidel_sweep(problem, lambda);
      if (stop.solved(lambda, change)) return {sweep, StopReason::converged};
      if (change == 0.0) return {sweep, StopReason::stagnated};
      changes.push_back(change);
      if (sweep < first || sweep == settings.max_iterations) continue;
      if (sweep == first && dense && newton) price = steps * of_step(nodes, lambda);
      // a rate that promises an end and doesn't keep it counts for nothing
      const double left = sweep > first + price ? price + 1.0 : sweeps_left(changes, goal);
      const double by_conjugate = dense && newton ? kConjugateSweep * kConjugateOfRoot * std::sqrt(left) : kInfinity;
      if (left <= std::min({price, by_conjugate, static_cast<double>(settings.max_iterations - sweep)})) continue;
      if (bodies) {
        LcpResult result{sweep, StopReason::stagnated};
        if (is_frictionless(problem) && n <= kMostActive) {
          result = pivot(problem, settings, sweep, lambda);
          if (has_ended(result, settings) || result.reason == StopReason::contradiction) return result;
        }
        return solve_bodies(problem, settings, is_cold, result.iterations, lambda);
      }
      if (!newton) return go_on(kConjugateSweeps, problem, settings, sweep, lambda);
      if (!dense) return go_on(kNewton, problem, settings, sweep, lambda);
      if (by_conjugate < price && conjugate_sweeps_end(problem, settings, goal, price, stop, sweep, lambda))
        return {sweep, StopReason::converged};
      if (sweep == settings.max_iterations) break;
      lambda = start;
      LcpResult result = go_on(kNewton, problem, settings, sweep, lambda);
      if (!has_ended(result, settings)) or_rounded(start, problem, settings, result, lambda);
      return result;
    }
    return {settings.max_iterations, StopReason::iteration_cap};
  }

 private:
  /// Contacts alone: beside equations Newton's digits are better where loads hang on light links.
  static bool is_frictionless(const ConeProblem& problem) {
    for (std::size_t i = 0; i < problem.q.size(); ++i)
      if (problem.kind_of(i) != RowKind::contact || problem.mu[i] != 0.0) return false;
    return true;
  }

  /// By the active set. Pivots are far cheaper than what iterations are counted for: so many are one of them.
  static LcpResult pivot(const ConeProblem& problem, const LcpSettings& settings, int spent,
                         std::vector<Vec3>& lambda) {
    LcpSettings of_pivots = settings;
    of_pivots.history = nullptr;
    of_pivots.max_iterations = kPivotsOfContact * static_cast<int>(lambda.size());
    const LcpResult result = go_on(kActiveSet, problem, of_pivots, 0, lambda);
    const int count = std::min(1 + result.iterations / kPivotsOfIteration, settings.max_iterations - spent);
    if (settings.history != nullptr) {
      const Residual residual = judge(problem, lambda);
      const double relative = settings.measure == Measure::siconos ? residual.siconos : residual.map.relative;
      settings.history->insert(settings.history->end(), static_cast<std::size_t>(count), relative);
    }
    return {spent + count, result.reason == StopReason::iteration_cap ? StopReason::stagnated : result.reason};
  }

  /// One of Newton's steps in sweeps, where W is dense: a factorization goes by the cube of the contacts that carry, or of
  /// the nodes, a sweep by contacts times contacts; what else a step needs is a few sweeps.
  static double of_step(const NodeSpace* nodes, const std::vector<Vec3>& lambda) {
    const auto carries = [](const Vec3& of_contact) { return !of_contact.isZero(0.0); };
    const double size = nodes != nullptr ? nodes->touched : std::count_if(lambda.begin(), lambda.end(), carries);
    return kSweepsOfStep + (nodes != nullptr ? kOfNodes : kOfRows) * size * size / static_cast<double>(lambda.size());
  }

  /// Whether no λ came: open contacts then make residuals small that are not near an answer.
  static bool is_zero(const std::vector<Vec3>& lambda) {
    return std::all_of(lambda.begin(), lambda.end(), [](const Vec3& of_contact) { return of_contact.isZero(0.0); });
  }

  /// What the rate of the last sweeps says.
  static double sweeps_left(const std::vector<double>& changes, double goal, std::size_t window = kWindow) {
    window = std::min(window, changes.size() - 1);
    const double now = changes.back(), before = changes[changes.size() - 1 - window];
    const double rate = std::pow(now / before, 1.0 / static_cast<double>(window));
    if (now <= goal) return 0.0;
    return rate < 1.0 ? std::log(goal / now) / std::log(rate) : std::numeric_limits<double>::infinity();
  }

  /// Conjugate sweeps as long as they promise to end what is left for less than `price` sweeps.
  static bool conjugate_sweeps_end(const ConeProblem& problem, const LcpSettings& settings, double goal, double price,
                                   SweepStop& stop, int& sweeps, std::vector<Vec3>& lambda) {
    ConjugateSweeps conjugate(problem);
    std::vector<double> changes;
    while (sweeps < settings.max_iterations) {
      const double change = conjugate.sweep(lambda);
      ++sweeps;
      if (stop.solved(lambda, change)) return true;
      changes.push_back(change);
      if (changes.size() % kConjugateWindow != 0) continue;
      const double spent = kConjugateSweep * static_cast<double>(changes.size()),
                   left = kConjugateSweep * sweeps_left(changes, goal, changes.size() - 1);
      if (left > price || spent > kTooFar * price) break;
    }
    return false;
  }

  /// Rounded equations from a λ that another method began with; the better one's is left. Whether nothing is left to do.
  static bool or_rounded(std::vector<Vec3> rounded, const ConeProblem& problem, const LcpSettings& settings,
                         LcpResult& result, std::vector<Vec3>& lambda) {
    result = go_on(kRounded, problem, settings, result.iterations, rounded);
    if (result.reason == StopReason::converged ||
        judge(problem, rounded).map.relative < judge(problem, lambda).map.relative)
      lambda = std::move(rounded);
    return has_ended(result, settings);
  }

  /// Of rigid bodies.
  static LcpResult solve_bodies(const ConeProblem& problem, const LcpSettings& settings, bool is_cold, int sweeps,
                                std::vector<Vec3>& lambda) {
    LcpResult result{sweeps, StopReason::stagnated};
    if (lambda.size() < kLarge) {
      const bool is_rough = lambda.size() >= kSome && settings.tolerance >= kFewDigits;
      if (is_rough && settings.measure == Measure::natural_map && come_near(problem, settings, result, lambda))
        return result;
      return by_what_there_is(problem, settings, result, lambda);
    }
    const bool is_rough = settings.tolerance >= kEnough;
    if (settings.measure != Measure::natural_map) {
      if (!bring_digits(kNewton, kFewSteps, problem, settings, result, lambda))
        result = by_what_there_is(problem, settings, result, lambda);
      return result;
    }
    LcpSettings enough = settings;
    enough.tolerance = std::max(settings.tolerance, kEnough);
    const auto is_within = [&](double relative) { return judge(problem, lambda).map.relative <= relative; };
    if (!is_within(enough.tolerance)) {
      const bool is_near = !is_cold || is_within(kInReach);
      if ((is_near || !bring_digits(kNewton, kFewSteps, problem, enough, result, lambda)) &&
          !come_near(problem, enough, result, lambda))
        result = by_what_there_is(problem, enough, result, lambda);
      if (is_rough || !result.solved()) return result;
    }
    if (bring_digits(kNewton, settings.is_in_motion ? kFewest : kFewSteps, problem, settings, result, lambda))
      return result;
    if ((settings.is_in_motion && !is_within(kAlmost)) ||
        bring_digits(kRounded, kSomeSteps, problem, settings, result, lambda) || !is_within(kNearEnough))
      return result;
    result = go_on(kConjugateSweeps, problem, settings, result.iterations, lambda, kLastDigits);
    if (!has_ended(result, settings)) bring_digits(kNewton, kFewSteps, problem, settings, result, lambda);
    return result;
  }

  /// Alternating directions; where they creep from the answer of widely rounded equations. Whether nothing is left to do.
  static bool come_near(const ConeProblem& problem, const LcpSettings& settings, LcpResult& result,
                        std::vector<Vec3>& lambda) {
    std::vector<Vec3> rounded = lambda;
    result = go_on(alternate_directions, problem, settings, result.iterations, lambda);
    if (has_ended(result, settings)) return true;
    LcpSettings wide = settings;
    wide.tolerance = std::max(settings.tolerance, kInReach);
    result = go_on(kRounded, problem, wide, result.iterations, rounded);
    result = go_on(alternate_directions, problem, settings, result.iterations, rounded);
    if (judge(problem, rounded).map.relative < judge(problem, lambda).map.relative) lambda = std::move(rounded);
    return has_ended(result, settings);
  }

  /// As many steps of a method as bring digits; whether nothing is left to do.
  static bool bring_digits(Solve* method, int steps, const ConeProblem& problem, const LcpSettings& settings,
                           LcpResult& result, std::vector<Vec3>& lambda) {
    double before, now = judge(problem, lambda).map.relative;
    do {
      result = go_on(method, problem, settings, result.iterations, lambda, steps);
      if (has_ended(result, settings)) return true;
      before = now, now = judge(problem, lambda).map.relative;
    } while (now < kGain * before);
    return false;
  }

  static bool has_ended(const LcpResult& result, const LcpSettings& settings) {
    return result.reason == StopReason::converged || result.iterations >= settings.max_iterations;
  }

  /// With many contacts rounded equations, with others Newton; then what else there is.
  static LcpResult by_what_there_is(const ConeProblem& problem, const LcpSettings& settings, LcpResult result,
                                    std::vector<Vec3>& lambda) {
    const auto go = [&](Solve* method, std::vector<Vec3>& from, int most) {
      result = go_on(method, problem, settings, result.iterations, from, most);
      return has_ended(result, settings);
    };
    const auto residual = [&](const std::vector<Vec3>& of) { return judge(problem, of).map.relative; };
    if (lambda.size() >= kLarge) {
      for (int round = 0; round < kRounds; ++round)
        if (go(kRounded, lambda, kAny) || go(kConjugateSweeps, lambda, kLastDigits) || go(kNewton, lambda, kMoreSteps))
          return result;
      if (residual(lambda) <= kNearEnough) return result;
    } else {
      const bool is_dear = lambda.size() >= kMany;
      const auto will_do = [&] { return is_dear && residual(lambda) <= kNearEnough; };
      const std::vector<Vec3> start = lambda;
      const bool ended = settings.is_in_motion && lambda.size() >= kSome
                             ? bring_digits(kNewton, kFewSteps, problem, settings, result, lambda)
                             : go(kNewton, lambda, kNewtonSteps);
      if (ended || or_rounded(start, problem, settings, result, lambda) || will_do() ||
          go(kNewton, lambda, is_dear ? kNewtonSteps : kAny) || will_do())
        return result;
    }
    std::vector<Vec3> other(lambda.size(), Vec3::Zero());
    const bool ended = go(kNewton, other, kAny);
    if (result.reason == StopReason::converged || residual(other) < kFarBetter * residual(lambda)) lambda = other;
    if (ended || go(kConjugateSweeps, lambda, kConjugate) || residual(lambda) <= kNearEnough) return result;
    if (go(kRounded, lambda, kAny)) return result;
    go(kNewton, lambda, kAny);
    return result;
  }

  /// At most `most` iterations of another method from `lambda`, which is left as it was if they don't better it.
  static LcpResult go_on(Solve* method, const ConeProblem& problem, LcpSettings settings, int spent,
                         std::vector<Vec3>& lambda, int most = kAny) {
    const std::vector<Vec3> before = lambda;
    const bool is_cut_short = most < settings.max_iterations - spent;
    settings.max_iterations = std::min(most, settings.max_iterations - spent);
    if (settings.max_iterations <= 0) return {spent, StopReason::iteration_cap};
    if (settings.history != nullptr) settings.history->pop_back();  // the next one begins with the same residual
    LcpResult result = method(problem, settings, lambda);
    if (!result.solved() && !(judge(problem, lambda).map.relative < judge(problem, before).map.relative))
      lambda = before;
    result.iterations += spent;
    if (is_cut_short && result.reason == StopReason::iteration_cap) result.reason = StopReason::stagnated;
    return result;
  }
};

}  // namespace

Entry<LcpSolver> automatic_solver() {
  return entry<LcpSolver, Automatic>(
      "automatic",
      "Gauss-Seidel; where it is slow conjugate sweeps (soft bodies), an active set (no friction), Newton, ADMM");
}

}  // namespace impinge
