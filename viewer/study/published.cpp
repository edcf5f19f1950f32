// impinge step of a published friction-contact problem: every cone solver on W, q and mu.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/frozen/read_friction_contact.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "viewer/study/methods.hpp"
#include "viewer/study/methods_report.hpp"

namespace impinge {
namespace {

constexpr double kExact = 1e-12;
constexpr int kMostExactIterations = 2000;
constexpr double kBrief = 100.0;  // ms: shorter runs are repeated
constexpr int kAtMostRuns = 3;
// an answer, near the reference in what it does, and not in what it is
constexpr double kSolved = 1e-6, kNear = 1e-3, kOther = 1e-2;

std::string regimes(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  int open = 0, stick = 0, slip = 0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    const double bound = problem.mu[i] * lambda[i].x();
    if (!(lambda[i].x() > 0.0))
      ++open;
    else if (lambda[i].tail<2>().norm() < bound * (1.0 - 1e-9))
      ++stick;
    else
      ++slip;
  }
  return fmt::format("{} open, {} stick, {} slip", open, stick, slip);
}

struct Solved {
  LcpResult result;
  double ms = 0.0;
  std::vector<Vec3> lambda;
};

Solved solve(const LcpSolver& solver, const ConeProblem& problem, const LcpSettings& settings) {
  Solved solved{{}, 0.0, std::vector<Vec3>(problem.q.size(), Vec3::Zero())};
  const auto begin = std::chrono::steady_clock::now();
  solved.result = solver.solve(problem, settings, solved.lambda);
  solved.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return solved;
}

/// √(λ^T W λ): what λ does to velocities, as an energy. Where contacts are redundant many λ do the same.
double energy_norm(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  std::vector<Vec3> w_lambda;
  problem.w->apply(lambda, w_lambda);
  double sum = 0.0;
  for (std::size_t i = 0; i < lambda.size(); ++i) sum += lambda[i].dot(w_lambda[i]);
  return std::sqrt(std::max(sum, 0.0));
}

/// Below what energy_norm can't tell from nothing: the rounding of its sum, whose terms cancel where W is singular. Each is
/// at most as large as the product of what the two contacts have by themselves (Cauchy and Schwarz).
double least_energy_norm(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  double sum = 0.0;
  for (std::size_t i = 0; i < lambda.size(); ++i)
    sum += std::sqrt(std::max(0.0, lambda[i].dot(problem.w->diagonal(i) * lambda[i])));
  return std::sqrt(std::numeric_limits<double>::epsilon()) * sum;
}

struct Distance {
  double value = 0.0;
  bool is_bound = false;   ///< what there is, is less than rounding
  double of_lambda = 0.0;  ///< of λ itself, relative
};

Distance distance(const ConeProblem& problem, std::vector<Vec3> lambda, const std::vector<Vec3>& exact) {
  double squares = 0.0, exact_squares = 0.0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    lambda[i] -= exact[i];
    squares += lambda[i].squaredNorm(), exact_squares += exact[i].squaredNorm();
  }
  const double size = energy_norm(problem, exact), error = energy_norm(problem, lambda),
               least = least_energy_norm(problem, lambda), unit = size > 0.0 ? size : 1.0;
  const double of_lambda = exact_squares > 0.0 ? std::sqrt(squares / exact_squares) : 0.0;
  return {std::max(error, least) / unit, (error < least), of_lambda};
}

/// The shortest of several, where they are short: what else the machine does shows less.
Solved timed(const LcpSolver& solver, const ConeProblem& problem, const LcpSettings& settings) {
  Solved solved = solve(solver, problem, settings);
  for (int k = 1; k < kAtMostRuns && solved.ms < kBrief; ++k)
    solved.ms = std::min(solved.ms, solve(solver, problem, settings).ms);
  return solved;
}

/// What of an answer is no number; "" where all of it is finite.
std::string not_finite(const std::vector<Vec3>& lambda, double residual) {
  constexpr const char* kRows[] = {"r_n", "r_t1", "r_t2"};
  for (std::size_t i = 0; i < lambda.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (!std::isfinite(lambda[i][d])) return fmt::format("{} of contact {} is not finite", kRows[d], i);
  return std::isfinite(residual) ? "" : "residual is not finite";
}

MethodReport report_of(const Entry<LcpSolver>& entry, const ConeProblem& problem, const LcpSettings& settings,
                       const std::vector<Vec3>& exact) {
  Solved solved = timed(*entry.make(), problem, settings);
  const Residual r = judge(problem, solved.lambda);
  MethodReport report;
  report.method = entry.name;
  report.iterations = solved.result.iterations;
  report.ms = solved.ms;
  report.residual = r.siconos;
  report.stop_reason = name_of(solved.result.reason);
  report.natural_map = r.natural_map, report.natural_map_relative = r.map.relative;
  report.worst_contact = r.worst;
  report.complementarity = r.complementarity, report.cone_violation = r.cone_violation;
  const Distance apart = distance(problem, solved.lambda, exact);
  report.distance = apart.value, report.distance_is_bound = apart.is_bound;
  report.distance_of_lambda = apart.of_lambda;
  if (std::string why = not_finite(solved.lambda, report.residual); !why.empty())
    report.stop_reason = std::move(why);
  else
    report.lambda = std::move(solved.lambda);
  return report;
}

/// Runs the method again: once to write down each residual, which takes time of its own, and stopped early.
void take_curves(const Entry<LcpSolver>& entry, const ConeProblem& problem, const LcpSettings& settings,
                 const std::vector<Vec3>& exact, MethodReport& report) {
  const auto solver = entry.make();
  LcpSettings own = settings;
  own.history = &report.history;
  solve(*solver, problem, own);
  own.history = nullptr;
  for (const int stop : early_stops(report.iterations)) {
    own.max_iterations = stop;
    const Solved solved = timed(*solver, problem, own);
    report.work.push_back(
        {stop, solved.ms, judge(problem, solved.lambda).siconos, distance(problem, solved.lambda, exact).value});
  }
  report.work.push_back({report.iterations, report.ms, report.residual, report.distance});
}

const Entry<LcpSolver>& best_reference(const ConeProblem& problem) {
  for (const Entry<LcpSolver>* entry : reference_solvers())
    if (entry->make()->applies(problem).empty()) return *entry;
  throw InternalError("no reference solver applies");
}

/// Other impulses that move nothing otherwise: contacts that are redundant share what they carry in many ways.
void say_if_not_unique(const StepReport& report) {
  const MethodReport* most = nullptr;
  for (const MethodReport& m : report.methods)
    if (m.residual < kSolved && m.distance < kNear && m.distance_of_lambda > kOther &&
        (most == nullptr || m.distance_of_lambda > most->distance_of_lambda))
      most = &m;
  if (most != nullptr)
    fmt::print(
        "note: λ is not unique here: that of {} differs from the reference's by {:.2g} % in itself, and by {}{:.1e} in "
        "W's norm\n",
        most->method, 100.0 * most->distance_of_lambda, most->distance_is_bound ? "less than " : "", most->distance);
}

}  // namespace

void step_published(const StepOptions& options) {
  const auto chosen = chosen_entries(lcp_solvers(), options.lcp, "solver", "--lcp");
  if (!options.responses.empty())
    throw InputError(fmt::format(
        "{}: has no bodies, so --response means nothing; a frozen step of impinge run --freeze is wanted; leave it out",
        options.file));
  const FrictionContactProblem read = read_friction_contact(options.file);
  const ConeProblem& problem = read.problem;
  LcpSettings settings{options.tolerance, options.max_iterations};
  settings.measure = Measure::siconos;
  const auto [least, most] = std::minmax_element(problem.mu.begin(), problem.mu.end());
  const std::string friction = *least == *most ? fmt::format("{}", *least) : fmt::format("{} to {}", *least, *most);
  fmt::print("{}: {} contacts, friction {}, {} of {} blocks of W\n", options.file, problem.q.size(), friction,
             read.w->blocks().size(), problem.q.size() * problem.q.size());

  std::vector<const Entry<LcpSolver>*> applying;
  std::vector<std::string> left_out;
  for (const Entry<LcpSolver>* entry : chosen) {
    const std::string why = entry->make()->applies(problem);
    if (why.empty())
      applying.push_back(entry);
    else
      left_out.push_back(fmt::format("{} does not apply: {}", entry->name, why));
  }
  if (applying.empty())
    throw InputError(
        fmt::format("{}: no chosen solver applies ({}); see impinge list lcp_solvers; choose others for --lcp",
                    options.file, left_out.front()));

  // what the others are held against, as exact as it comes
  const Entry<LcpSolver>& reference_solver = best_reference(problem);
  LcpSettings exactly{kExact, kMostExactIterations};
  exactly.measure = Measure::siconos;
  const std::vector<Vec3> exact = solve(*reference_solver.make(), problem, exactly).lambda;
  const Residual reached = judge(problem, exact);
  fmt::print("reference: {} at {:.0e}; residual {:.1e}, natural map {:.1e} m/s\n", reference_solver.name, kExact,
             reached.siconos, reached.natural_map);

  StepReport report{std::filesystem::path(options.file).filename().string(),
                    "residual (Siconos), relative",
                    "",
                    false,
                    "mu,",
                    {},
                    {}};
  for (const double mu : problem.mu) report.solution_columns.push_back(fmt::format("{},", mu));
  TablePrinter table(false);
  for (const Entry<LcpSolver>* entry : applying) {
    report.methods.push_back(report_of(*entry, problem, settings, exact));
    table.row(report.methods.back());
    if (!options.out.empty() && !report.methods.back().lambda.empty())
      take_curves(*entry, problem, settings, exact, report.methods.back());
  }
  for (const std::string& line : left_out) fmt::print("{}\n", line);
  const auto rank = [](const MethodReport& m) { return m.lambda.empty() ? HUGE_VAL : m.residual; };
  const MethodReport& best = *std::min_element(report.methods.begin(), report.methods.end(),
                                               [&](const auto& l, const auto& r) { return rank(l) < rank(r); });
  if (!best.lambda.empty()) fmt::print("smallest residual: {}, {}\n", best.method, regimes(problem, best.lambda));
  fmt::print(
      "residual: by Siconos' definition; natural map: m/s, with the contact where it is worst; distance: of λ to the "
      "reference in W's norm, relative\n");
  say_if_not_unique(report);
  if (!options.out.empty()) write_report(options.out, report);
  if (best.lambda.empty())
    throw DivergenceError(
        fmt::format("{}: no method reaches a finite residual; {}: {}", options.file, best.method, best.stop_reason));
}

}  // namespace impinge
