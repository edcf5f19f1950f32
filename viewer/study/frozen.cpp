// impinge step of a frozen step: every response with every cone solver, held against the exact solution.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/frozen/finite_answer.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/world/parameters.hpp"
#include "viewer/study/methods.hpp"
#include "viewer/study/methods_report.hpp"

namespace impinge {
namespace {

// a residual that others would take for an answer, and a distance that is none
constexpr double kSmall = 1e-6, kFar = 1e-2;

constexpr double kQuick = 100.0;  // ms: shorter runs are repeated, and the shortest counts
constexpr int kRepeats = 3;

class Comparison {
 public:
  /// `settings`: the run's, those of methods too.
  Comparison(const StepOptions& options, const Parameters& settings, const FrozenStep& step, const FrozenRuler& ruler)
      : settings_(settings), step_(step), ruler_(ruler), curves_(!options.out.empty()) {
    context_ = response_context(settings);
    context_.time_step = step.time_step;
    context_.lcp = {options.tolerance, options.max_iterations};
  }

  /// One row for each solver, or one where the response has no use for a cone solver.
  void run(const Entry<Response>& entry, const ResponseVariant& variant,
           const std::vector<const Entry<LcpSolver>*>& solvers, std::vector<MethodReport>& reports) {
    const auto response = entry.make();
    copy_settings(settings_.response.method.at(entry.name), *response);
    configure(*response, variant.rows);
    const IterationSetting own = response->iteration_setting();
    if (own.count != nullptr && !own.is_exact) *own.count = context_.lcp.max_iterations;
    const std::string name = std::string(entry.name) + variant.suffix;
    for (const Entry<LcpSolver>* solver : solvers) {
      const LcpSolver& lcp = settings_.lcp.method.at(solver->name);
      std::optional<FrozenOutcome> outcome;
      std::string diverged;
      try {
        outcome = timed(*response, lcp, context_);
      } catch (const DivergenceError& error) {
        diverged = error.what();
      }
      MethodReport report;
      report.method = outcome && outcome->used_solver ? fmt::format("{}-{}", name, solver->name) : name;
      if (outcome) {
        fill(*outcome, report);
      } else {
        report.stop_reason = "diverged";
        for (double* figure : {&report.residual, &report.natural_map, &report.natural_map_relative, &report.momentum,
                               &report.complementarity, &report.cone_violation, &report.distance})
          *figure = NAN;
      }
      table_.row(report);
      if (!diverged.empty()) fmt::print("  {}\n", diverged);
      if (report.lambda.empty() && first_failure_.empty())
        first_failure_ = fmt::format("{}: {}", report.method, diverged.empty() ? report.stop_reason : diverged);
      if (!report.lambda.empty() && curves_) take_curves(*response, lcp, *outcome, report);
      reports.push_back(std::move(report));
      if (!outcome || !outcome->used_solver) return;
    }
  }

  /// Of the first method that came to no finite answer; "" if there is none.
  const std::string& first_failure() const { return first_failure_; }

 private:
  FrozenOutcome timed(const Response& response, const LcpSolver& lcp, const ResponseContext& context) const {
    FrozenOutcome outcome = solve_frozen(step_, response, lcp, context);
    for (int k = 1; k < kRepeats && outcome.ms < kQuick; ++k)
      outcome.ms = std::min(outcome.ms, solve_frozen(step_, response, lcp, context).ms);
    return outcome;
  }

  void fill(const FrozenOutcome& outcome, MethodReport& report) const {
    const FrozenVerdict verdict = ruler_.judge(outcome.answers);
    report.iterations = outcome.iterations, report.outer_iterations = outcome.outer_iterations;
    report.ms = outcome.ms;
    report.residual = verdict.residual;
    report.natural_map = verdict.natural_map, report.natural_map_relative = verdict.natural_map_relative,
    report.momentum = verdict.momentum;
    report.worst_contact = verdict.worst;
    report.complementarity = verdict.complementarity, report.cone_violation = verdict.cone_violation;
    report.distance = verdict.distance;
    report.stop_reason =
        outcome.converged && !(verdict.residual <= context_.lcp.tolerance) ? "ended above the tolerance" : outcome.stop;
    if (const std::string why = not_finite(step_, outcome.answers, verdict); !why.empty()) {
      report.stop_reason = why;
      return;
    }
    for (const GroupAnswer& answer : outcome.answers)
      report.lambda.insert(report.lambda.end(), answer.lambda.begin(), answer.lambda.end());
  }

  void take_curves(Response& response, const LcpSolver& lcp, const FrozenOutcome& outcome, MethodReport& report) const {
    const bool has_loop = outcome.outer_iterations > static_cast<int>(step_.groups.size());
    report.history = solve_frozen(step_, response, lcp, context_, &ruler_).history;
    const bool shows_nothing = report.history.empty();
    if (shows_nothing) report.history.push_back(ruler_.judge(start()).residual);
    // what is stopped is the method's own loop, where it has one
    const IterationSetting own = response.iteration_setting();
    const int whole = own.count == nullptr ? 0 : *own.count;
    for (const int stop : early_stops(has_loop ? outcome.outer_iterations : outcome.iterations)) {
      ResponseContext context = context_;
      if (own.count != nullptr) *own.count = stop;
      if (!has_loop) context.lcp.max_iterations = stop;
      const FrozenOutcome early = timed(response, lcp, context);
      const FrozenVerdict verdict = ruler_.judge(early.answers);
      report.work.push_back({stop, early.ms, verdict.residual, verdict.distance});
      if (early.converged && !own.is_exact) break;  // no cap was met: more would be the same again
    }
    if (own.count != nullptr) *own.count = whole;
    report.work.push_back(
        {has_loop ? outcome.outer_iterations : outcome.iterations, report.ms, report.residual, report.distance});
    if (shows_nothing) report.history.push_back(report.residual);
  }

  /// Nothing done: Δv = 0.
  std::vector<GroupAnswer> start() const {
    std::vector<GroupAnswer> list;
    for (const FrozenGroup& group : step_.groups)
      list.push_back({std::vector<Vec3>(group.system.contacts.size(), Vec3::Zero()), group.system.delta_velocity,
                      group.system.delta_angular_velocity, group.system.deformable_delta});
    return list;
  }

  const Parameters& settings_;
  const FrozenStep& step_;
  const FrozenRuler& ruler_;
  ResponseContext context_;
  bool curves_;
  std::string first_failure_;
  TablePrinter table_{true};
};

void print_head(const FrozenStep& step, const Parameters& settings, const FrozenRuler& ruler, const std::string& file) {
  std::size_t rigid = 0, soft = 0, unknowns = 0;
  for (const FrozenGroup& group : step.groups) {
    rigid += group.system.rigid.size(), soft += group.matrices.size();
    unknowns += 6 * group.system.rigid.size();
    for (const BlockMatrix& a : group.matrices) unknowns += static_cast<std::size_t>(a.rows());
  }
  fmt::print(
      "{}: {}, frame {}, Δt {:.4g} s; {} contacts in {} group{}, {} rigid and {} deformable bodies, {} unknowns\n",
      file, step.scene, step.frame, step.time_step, step.contacts(), step.groups.size(),
      step.groups.size() == 1 ? "" : "s", rigid, soft, unknowns);
  const FrozenVerdict exact = ruler.unsolved().empty() ? ruler.judge(ruler.exact()) : FrozenVerdict{};
  if (!ruler.unsolved().empty())
    fmt::print("exact solution: none {}; distances are not known\n", ruler.unsolved());
  else
    fmt::print("exact solution: {} with {}; natural map {:.1e} m/s, relative {:.1e}, momentum {:.1e} m/s\n",
               ruler.exact_response(), ruler.exact_solver(), exact.natural_map, exact.natural_map_relative,
               exact.momentum);
  std::vector<GroupAnswer> run;
  for (const FrozenGroup& group : step.groups) run.push_back(group.answer);
  const FrozenVerdict found = ruler.judge(run);
  const auto known = [](double value) { return std::isfinite(value) ? fmt::format("{:.2e}", value) : "not known"; };
  fmt::print("the run, {} with {} at {:.0e}: residual {}, distance {}\n", settings.response.method.name(),
             settings.lcp.method.name(), settings.lcp.tolerance, known(found.residual), known(found.distance));
}

/// A residual says little where many answers nearly satisfy the step: a body on more contacts than it needs, that
/// slides.
void say_if_undetermined(const StepReport& report) {
  const MethodReport* worst = nullptr;
  for (const MethodReport& m : report.methods)
    if (m.residual < kSmall && m.distance > kFar && (worst == nullptr || m.distance > worst->distance)) worst = &m;
  if (worst != nullptr)
    fmt::print(
        "note: this step hardly determines its answer: {} has a residual of {:.1e} at a distance of {:.1e}. Other "
        "answers satisfy the laws nearly as well as the one that\n"
        "distances are taken from; compare residuals here\n",
        worst->method, worst->residual, worst->distance);
}

}  // namespace

void step_frozen(const StepOptions& options) {
  const auto chosen = chosen_entries(responses(), options.responses, "response", "--response");
  const auto named = chosen_entries(lcp_solvers(), options.lcp, "solver", "--lcp");
  const FrozenStep step = read_frozen_step(options.file);
  if (step.contacts() == 0)
    throw InputError(fmt::format("{}: frame {} of {} has no contacts; a step with some is wanted; freeze another frame",
                                 options.file, step.frame, step.scene));
  Parameters settings;
  try {
    take_settings(step.settings, settings);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: settings: {}; write it anew with impinge run --freeze", options.file, error.what()));
  }
  const FrozenRuler ruler(step);
  std::vector<const Entry<LcpSolver>*> solvers;
  std::vector<std::string> left_out;
  for (const Entry<LcpSolver>* entry : named) {
    const std::string why = ruler.applies(*entry->make());
    if (why.empty())
      solvers.push_back(entry);
    else
      left_out.push_back(fmt::format("{} does not apply: {}", entry->name, why));
  }
  if (solvers.empty())
    throw InputError(
        fmt::format("{}: no chosen solver applies ({}); see impinge list lcp_solvers; choose others for --lcp",
                    options.file, left_out.front()));

  print_head(step, settings, ruler, options.file);
  StepReport report{fmt::format("{}, frame {}, {} contacts", step.scene, step.frame, step.contacts()),
                    "residual, relative",
                    "distance to the exact change of velocity in A's norm, relative",
                    true,
                    "group,body_a,body_b,mu,",
                    {},
                    {}};
  for (std::size_t g = 0; g < step.groups.size(); ++g)
    for (std::size_t i = 0; i < step.groups[g].geometry.size(); ++i) {
      const auto name = [&](int b) { return b < 0 ? std::string("world") : step.bodies[static_cast<std::size_t>(b)]; };
      const FrozenContact& at = step.groups[g].geometry[i];
      report.solution_columns.push_back(
          fmt::format("{},{},{},{},", g, name(at.body_a), name(at.body_b), step.groups[g].system.contacts[i].friction));
    }
  Comparison comparison(options, settings, step, ruler);
  for (const Entry<Response>* response : chosen)
    for (const ResponseVariant& variant : response->make()->variants(step.is_block_diagonal())) {
      // with one solver, unless some are named
      const bool one = variant.solves_in_a_loop && options.lcp.empty();
      comparison.run(*response, variant, one ? std::vector{solvers.front()} : solvers, report.methods);
    }
  for (const std::string& line : left_out) fmt::print("{}\n", line);
  fmt::print(
      "residual: natural map or momentum, whichever is larger, relative to the largest |J v* - bound|; natural map and "
      "momentum: m/s; distance: of Δv to the\n"
      "exact one in A's norm, relative; ms: with factorizations and W, which a run shares between sub-steps where A "
      "stays\n");
  say_if_undetermined(report);
  if (!options.out.empty()) write_report(options.out, report);
  if (std::all_of(report.methods.begin(), report.methods.end(), [](const auto& m) { return m.lambda.empty(); }))
    throw DivergenceError(fmt::format("{}: frame {}: no method reaches a finite residual; {}", options.file, step.frame,
                                      comparison.first_failure()));
}

}  // namespace impinge
