#include "engine/frozen/frozen_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/factored_delassus.hpp"

namespace impinge {
namespace {

constexpr double kExact = 1e-12;
constexpr int kMostExactIterations = 2000;

/// Hands everything on, and counts how often it was asked.
class WatchedSolver : public LcpSolver {
 public:
  explicit WatchedSolver(const LcpSolver& solver) : solver_(solver) {}
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    ++calls;
    return solver_.solve(problem, settings, lambda);
  }
  std::string applies(const ConeProblem& problem) const override { return solver_.applies(problem); }
  mutable int calls = 0;

 private:
  const LcpSolver& solver_;
};

/// The frozen system with an answer in it, for those who look at it only.
GroupSystem with_answer(const FrozenGroup& group, const GroupAnswer& answer) {
  GroupSystem system = group.system;
  for (std::size_t s = 0; s < group.matrices.size(); ++s) system.deformable[s].a = &group.matrices[s];
  system.lambda = answer.lambda;
  system.delta_velocity = answer.delta_velocity;
  system.delta_angular_velocity = answer.delta_angular_velocity;
  system.deformable_delta = answer.deformable_delta;
  return system;
}

std::vector<Mat3> w_diagonal(ThawedGroup& thawed) {
  std::vector<Mat3> diagonal;
  const auto take = [&](const Delassus& w) {
    for (std::size_t i = 0; i < w.contacts(); ++i) diagonal.push_back(w.diagonal(i));
  };
  GroupSystem& system = thawed.system;
  if (std::all_of(system.deformable.begin(), system.deformable.end(),
                  [](const DeformableBlock& b) { return b.is_diagonal; })) {
    const auto inverse = inverse_node_blocks(system);
    take(FactoredDelassus(system, &inverse));
  } else {
    take(AssembledDelassus(system));
  }
  return diagonal;
}

double ratio(double value, double scale) {
  if (!std::isfinite(scale)) return std::numeric_limits<double>::quiet_NaN();  // or anything would be nothing to it
  return scale > 0.0 ? value / scale : value;
}

const Entry<Response>& reference_response() {
  for (const Entry<Response>& entry : responses())
    if (entry.make()->is_reference()) return entry;
  throw InternalError("no response is a reference");
}

/// The larger of two histories, iteration by iteration; what has ended keeps its last value.
void merge_history(std::vector<double>& into, const std::vector<double>& from) {
  if (from.empty()) return;
  if (into.empty()) {
    into = from;
    return;
  }
  const std::size_t n = std::max(into.size(), from.size());
  into.resize(n, into.back());
  for (std::size_t k = 0; k < n; ++k) into[k] = std::max(into[k], k < from.size() ? from[k] : from.back());
}

}  // namespace

FrozenRuler::FrozenRuler(const FrozenStep& step) : step_(step) {
  const Entry<Response>& reference = reference_response();
  const auto response = reference.make();
  exact_response_ = reference.name;
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    const FrozenGroup& group = step.groups[g];
    ThawedGroup thawed = thaw(group, step.linear_solver);
    const ConeProblem problem = make_cone_problem(thawed.system);
    scale_.push_back(velocity_scale(problem));
    w_diagonal_.emplace_back();
    GroupAnswer exact;
    std::string method, why = "no method reaches a finite residual";
    try {
      w_diagonal_.back() = w_diagonal(thawed);
      method = solve_exactly(*response, g, problem, thawed, exact);
    } catch (const DivergenceError& error) {
      why = error.what();
    }
    if (method.empty() && unsolved_.empty()) unsolved_ = fmt::format("of group {}: {}", g, why);
    exact_.push_back(std::move(exact));
    if (exact_solver_.find(method) == std::string::npos) exact_solver_ += (exact_solver_.empty() ? "" : ", ") + method;
    if (unsolved_.empty()) exact_norm_ += energy_product(group, exact_[g], exact_[g]);
  }
  exact_norm_ = unsolved_.empty() ? std::sqrt(exact_norm_) : std::numeric_limits<double>::quiet_NaN();
}

/// The nearest of what there is; the first is near enough unless the problem is ill-posed or too large for it. Returns
/// what came nearest, "" where nothing came to a finite residual.
std::string FrozenRuler::solve_exactly(const Response& response, std::size_t g, const ConeProblem& problem,
                                       ThawedGroup& thawed, GroupAnswer& exact) const {
  double best = std::numeric_limits<double>::infinity();
  std::string method;
  for (const bool warm : {true, false})
    for (const Entry<LcpSolver>* entry : reference_solvers()) {
      const auto solver = entry->make();
      if (!solver->applies(problem).empty() || best <= kExact) continue;
      if (warm)
        thawed.system.lambda = step_.groups[g].system.lambda;
      else
        thawed.system.lambda.assign(problem.q.size(), Vec3::Zero());
      ResponseContext context;
      context.lcp = {0.1 * kExact, kMostExactIterations};
      response.solve(thawed.system, *solver, context);
      const GroupAnswer answer{thawed.system.lambda, thawed.system.delta_velocity, thawed.system.delta_angular_velocity,
                               thawed.system.deformable_delta};
      const double reached = residual(g, thawed.system);
      if (!(reached < best) || !is_finite(answer)) continue;
      best = reached;
      method = entry->name;
      exact = answer;
    }
  return method;
}

double FrozenRuler::residual(std::size_t group, const GroupSystem& solved) const {
  return ratio(judge_group(solved, diagonal(group)).residual(), scale_[group]);
}

const std::vector<Mat3>* FrozenRuler::diagonal(std::size_t group) const {
  return w_diagonal_[group].empty() ? nullptr : &w_diagonal_[group];
}

FrozenVerdict FrozenRuler::judge(const std::vector<GroupAnswer>& answers) const {
  FrozenVerdict all;
  int first = 0;
  double squared = 0.0;
  for (std::size_t g = 0; g < answers.size(); ++g) {
    const GroupSystem system = with_answer(step_.groups[g], answers[g]);
    const GroupVerdict verdict = judge_group(system, diagonal(g));
    if (!std::isnan(all.natural_map) && !(verdict.natural_map <= all.natural_map)) {
      all.natural_map = verdict.natural_map;
      all.worst = verdict.worst < 0 ? -1 : first + verdict.worst;
    }
    const auto raise = [](double& to, double value) { to = larger(to, value); };
    raise(all.natural_map_relative, ratio(verdict.natural_map, scale_[g]));
    raise(all.momentum, verdict.momentum);
    raise(all.residual, ratio(verdict.residual(), scale_[g]));
    const ConeProblem problem = make_cone_problem(system);
    for (std::size_t i = 0; i < problem.q.size(); ++i) {
      if (problem.kind[i] != RowKind::contact) continue;
      Vec3 u = system.contact_velocity(i, true);
      u.x() -= system.contacts[i].bound;
      raise(all.complementarity, std::abs(system.lambda[i].dot(problem.dual(i, u))));
      raise(all.cone_violation, problem.violation(i, system.lambda[i]));
    }
    const double d = unsolved_.empty() ? energy_distance(step_.groups[g], answers[g], exact_[g]) : 0.0;
    squared += d * d;
    first += static_cast<int>(problem.q.size());
  }
  all.distance = ratio(std::sqrt(squared), exact_norm_);
  return all;
}

std::string FrozenRuler::applies(const LcpSolver& solver) const {
  for (const FrozenGroup& group : step_.groups)
    if (std::string why = solver.applies(make_cone_problem(with_answer(group, group.answer))); !why.empty()) return why;
  return "";
}

FrozenOutcome solve_frozen(const FrozenStep& step, const Response& response, const LcpSolver& solver,
                           const ResponseContext& context, const FrozenRuler* ruler) {
  FrozenOutcome outcome;
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    ThawedGroup thawed = thaw(step.groups[g], step.linear_solver);
    WatchedSolver watched(solver);
    ResponseContext own = context;
    std::vector<double> of_solver, of_loop;
    if (ruler != nullptr) {
      own.lcp.history = &of_solver;
      own.observe = [&](const GroupSystem& now) { of_loop.push_back(ruler->residual(g, now)); };
    }
    const auto begin = std::chrono::steady_clock::now();
    const ResponseResult result = response.solve(thawed.system, watched, own);
    outcome.ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    outcome.iterations += result.iterations;
    outcome.outer_iterations += result.outer_iterations;
    outcome.used_solver |= watched.calls > 0;
    if (outcome.converged) {
      outcome.converged = result.converged();
      outcome.stop = std::string(name_of(result.ended));
    }
    merge_history(outcome.history, !of_loop.empty() ? of_loop : watched.calls == 1 ? of_solver : std::vector<double>());
    GroupSystem& s = thawed.system;
    outcome.answers.push_back({std::move(s.lambda), std::move(s.delta_velocity), std::move(s.delta_angular_velocity),
                               std::move(s.deformable_delta)});
  }
  return outcome;
}

}  // namespace impinge
