// impinge step of a frozen step: every response with every cone solver, held against the exact solution.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/frozen/frozen_comparison.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "viewer/study/methods.hpp"
#include "viewer/study/methods_report.hpp"

namespace impinge {
namespace {

// a residual that others would take for an answer, and a distance that is none
constexpr double kSmall = 1e-6, kFar = 1e-2;

constexpr double kQuick = 100.0;  // ms: shorter runs are repeated, and the shortest counts
constexpr int kRepeats = 3;
constexpr double kFarAbove = 10.0;  // times the tolerance: what claims to have converged there has not

/// A way of running a response that gets rows of its own.
struct Variant {
  const Entry<Response>* response;
  std::string suffix, form, stop;
};

std::vector<Variant> variants_of(const Entry<Response>& response, const FrozenStep& step) {
  std::vector<Variant> list = {{&response, "", step.settings.form, step.settings.stop}};
  bool one_step = true;  // rigid bodies, and matrices that are block diagonal, leave its loop nothing to do
  for (const FrozenGroup& group : step.groups)
    for (const SoftBlock& block : group.system.soft) one_step &= block.is_diagonal;
  if (response.name != "iterative_constraint_anticipation" || one_step) return list;
  // the forms that this method is known in: how far the printed one and its 5 % rule are from the solution
  list[0].form = "accelerated", list[0].stop = "residual";
  list.push_back({&response, "_5_percent", "accelerated", "change"});
  list.push_back({&response, "_seed", "seed", "residual"});
  list.push_back({&response, "_seed_5_percent", "seed", "change"});
  return list;
}

class Comparison {
 public:
  Comparison(const StepOptions& options, const FrozenStep& step, const FrozenRuler& ruler)
      : step_(step), ruler_(ruler), curves_(!options.out.empty()) {
    settings_ = step.settings;
    settings_.lcp = {options.tolerance, options.max_iterations};
    settings_.max_outer_iterations = settings_.impulse_iterations = options.max_iterations;
  }

  /// One row for each solver, or one where the response has no use for a cone solver.
  void run(const Variant& variant, const std::vector<const Entry<LcpSolver>*>& solvers,
           std::vector<MethodReport>& reports) {
    const auto response = variant.response->make();
    ResponseSettings settings = settings_;
    settings.form = variant.form, settings.stop = variant.stop;
    const std::string name = std::string(variant.response->name) + variant.suffix;
    for (const Entry<LcpSolver>* solver : solvers) {
      const auto lcp = solver->make();
      std::optional<FrozenOutcome> outcome;
      std::string diverged;
      try {
        outcome = timed(*response, *lcp, settings);
      } catch (const DivergenceError& error) {
        diverged = error.what();
      }
      MethodReport report;
      report.method = outcome && outcome->used_solver ? fmt::format("{}-{}", name, solver->name) : name;
      if (outcome) {
        fill(*outcome, settings, report);
      } else {
        report.stop_reason = "diverged";
        for (double* figure :
             {&report.residual, &report.natural_map, &report.natural_map_relative, &report.momentum, &report.distance})
          *figure = NAN;
        report.lambda.assign(step_.contacts(), Vec3::Zero());
      }
      table_.row(report);
      if (!diverged.empty()) fmt::print("  {}\n", diverged);
      if (outcome && curves_) take_curves(*response, *lcp, settings, *outcome, report);
      reports.push_back(std::move(report));
      if (!outcome || !outcome->used_solver) return;
    }
  }

 private:
  FrozenOutcome timed(const Response& response, const LcpSolver& lcp, const ResponseSettings& settings) const {
    FrozenOutcome outcome = solve_frozen(step_, response, lcp, settings);
    for (int k = 1; k < kRepeats && outcome.ms < kQuick; ++k)
      outcome.ms = std::min(outcome.ms, solve_frozen(step_, response, lcp, settings).ms);
    return outcome;
  }

  void fill(const FrozenOutcome& outcome, const ResponseSettings& settings, MethodReport& report) const {
    const FrozenVerdict verdict = ruler_.judge(outcome.answers);
    report.iterations = outcome.iterations, report.outer_iterations = outcome.outer_iterations;
    report.ms = outcome.ms;
    report.residual = verdict.residual;
    report.natural_map = verdict.natural_map, report.natural_map_relative = verdict.natural_map_relative,
    report.momentum = verdict.momentum;
    report.worst_contact = verdict.worst;
    report.complementarity = verdict.complementarity, report.cone_violation = verdict.cone_violation;
    report.distance = verdict.distance;
    report.stop_reason = outcome.converged && !(verdict.residual <= kFarAbove * settings.lcp.tolerance)
                             ? "ended above the tolerance"
                             : outcome.stop;
    for (const GroupAnswer& answer : outcome.answers)
      report.lambda.insert(report.lambda.end(), answer.lambda.begin(), answer.lambda.end());
  }

  void take_curves(const Response& response, const LcpSolver& lcp, const ResponseSettings& settings,
                   const FrozenOutcome& outcome, MethodReport& report) const {
    const bool has_loop = outcome.outer_iterations > static_cast<int>(step_.groups.size());
    report.history = solve_frozen(step_, response, lcp, settings, &ruler_).history;
    const bool shows_nothing = report.history.empty();
    if (shows_nothing) report.history.push_back(ruler_.judge(start()).residual);
    // what is stopped is the outer loop, where there is one
    for (const int stop : early_stops(has_loop ? outcome.outer_iterations : outcome.iterations)) {
      ResponseSettings own = settings;
      own.max_outer_iterations = stop;
      if (!has_loop) own.lcp.max_iterations = own.impulse_iterations = own.soft_iterations = stop;
      const FrozenOutcome early = timed(response, lcp, own);
      const FrozenVerdict verdict = ruler_.judge(early.answers);
      report.work.push_back({stop, early.ms, verdict.residual, verdict.distance});
      if (early.converged) break;  // no cap was met: more would be the same again
    }
    report.work.push_back(
        {has_loop ? outcome.outer_iterations : outcome.iterations, report.ms, report.residual, report.distance});
    if (shows_nothing) report.history.push_back(report.residual);
  }

  /// Nothing done: Δv = 0.
  std::vector<GroupAnswer> start() const {
    std::vector<GroupAnswer> list;
    for (const FrozenGroup& group : step_.groups)
      list.push_back({std::vector<Vec3>(group.system.contacts.size(), Vec3::Zero()), group.system.delta_velocity,
                      group.system.delta_angular_velocity, group.system.soft_delta});
    return list;
  }

  const FrozenStep& step_;
  const FrozenRuler& ruler_;
  ResponseSettings settings_;
  bool curves_;
  TablePrinter table_{true};
};

void print_head(const FrozenStep& step, const FrozenRuler& ruler, const std::string& file) {
  std::size_t rigid = 0, soft = 0, unknowns = 0;
  for (const FrozenGroup& group : step.groups) {
    rigid += group.system.bodies.size(), soft += group.matrices.size();
    unknowns += 6 * group.system.bodies.size();
    for (const BlockMatrix& a : group.matrices) unknowns += static_cast<std::size_t>(a.rows());
  }
  fmt::print(
      "{}: {}, frame {}, Δt {:.4g} s; {} contacts in {} group{}, {} rigid and {} deformable bodies, {} unknowns\n",
      file, step.scene, step.frame, step.time_step, step.contacts(), step.groups.size(),
      step.groups.size() == 1 ? "" : "s", rigid, soft, unknowns);
  const FrozenVerdict exact = ruler.judge(ruler.exact());
  fmt::print(
      "exact solution: constraint_anticipation with {}; natural map {:.1e} m/s, relative {:.1e}, momentum {:.1e} m/s\n",
      ruler.exact_method(), exact.natural_map, exact.natural_map_relative, exact.momentum);
  std::vector<GroupAnswer> run;
  for (const FrozenGroup& group : step.groups) run.push_back(group.answer);
  const FrozenVerdict found = ruler.judge(run);
  fmt::print("the run, {} with {} at {:.0e}: residual {:.2e}, distance {:.2e}\n", step.response, step.lcp,
             step.settings.lcp.tolerance, found.residual, found.distance);
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

  print_head(step, ruler, options.file);
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
  Comparison comparison(options, step, ruler);
  for (const Entry<Response>* response : chosen)
    for (const Variant& variant : variants_of(*response, step)) {
      // the printed form solves inside each of its iterations: with one solver, unless some are named
      const bool one = variant.form == "seed" && options.lcp.empty();
      comparison.run(variant, one ? std::vector{solvers.front()} : solvers, report.methods);
    }
  for (const std::string& line : left_out) fmt::print("{}\n", line);
  fmt::print(
      "residual: natural map or momentum, whichever is larger, relative to the largest |J v* - bound|; natural map and "
      "momentum: m/s; distance: of Δv to the\n"
      "exact one in A's norm, relative; ms: with factorizations and W, which a run shares between sub-steps where A "
      "stays\n");
  say_if_undetermined(report);
  if (!options.out.empty()) write_report(options.out, report);
}

}  // namespace impinge
