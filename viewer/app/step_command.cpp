// impinge step: one problem, solved by every method, all judged by the same residual.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/file.hpp"
#include "engine/io/read_friction_contact.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "viewer/app/commands.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

struct Outcome {
  std::string method;
  LcpResult result;
  double ms = 0.0;
  Residual residual;
  std::vector<Vec3> lambda;
  std::vector<double> history;
};

std::vector<const Entry<LcpSolver>*> chosen_solvers(const std::vector<std::string>& names) {
  std::vector<const Entry<LcpSolver>*> chosen;
  if (names.empty())
    for (const auto& e : lcp_solvers()) chosen.push_back(&e);
  for (const std::string& name : names) {
    const auto* found = find_entry(lcp_solvers(), name);
    if (found == nullptr) {
      std::vector<std::string> all;
      for (const auto& e : lcp_solvers()) all.emplace_back(e.name);
      const std::string near = nearest_word(name, all);
      throw InputError(fmt::format("command line: unknown solver '{}' in --lcp; allowed: {}; {}", name, fmt::join(all, ", "),
                                   near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near)));
    }
    if (std::find(chosen.begin(), chosen.end(), found) == chosen.end()) chosen.push_back(found);
  }
  return chosen;
}

std::string regimes(const ConeProblem& problem, const std::vector<Vec3>& lambda) {
  int open = 0, stick = 0, slip = 0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    const double bound = problem.mu[i] * lambda[i].x();
    if (!(lambda[i].x() > 0.0)) ++open;
    else if (lambda[i].tail<2>().norm() < bound * (1.0 - 1e-9)) ++stick;
    else ++slip;
  }
  return fmt::format("{} open, {} stick, {} slip", open, stick, slip);
}

Outcome solve(const Entry<LcpSolver>& entry, const ConeProblem& problem, const LcpSettings& settings, bool history) {
  Outcome outcome{std::string(entry.name), {}, 0.0, {}, std::vector<Vec3>(problem.q.size(), Vec3::Zero()), {}};
  const auto solver = entry.make();
  const auto begin = std::chrono::steady_clock::now();
  outcome.result = solver->solve(problem, settings, outcome.lambda);
  outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  outcome.residual = judge(problem, outcome.lambda);
  if (!history) return outcome;
  // a second time, since writing down each residual takes time of its own
  LcpSettings watched = settings;
  watched.history = &outcome.history;
  std::vector<Vec3> lambda(problem.q.size(), Vec3::Zero());
  solver->solve(problem, watched, lambda);
  return outcome;
}

std::string methods_table(const std::vector<Outcome>& outcomes) {
  std::string text = "method,iterations,ms,residual,stop_reason,natural_map_m_per_s,natural_map_relative,worst_contact,complementarity_J,cone_violation_Ns\n";
  for (const Outcome& o : outcomes)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", o.method, o.result.iterations, o.ms, o.residual.siconos, name_of(o.result.reason), o.residual.natural_map,
                        o.residual.map.relative, o.residual.worst, o.residual.complementarity, o.residual.cone_violation);
  return text;
}

void write_outcomes(const fs::path& folder, const ConeProblem& problem, const std::vector<Outcome>& outcomes) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out", folder.string(), error.message()));
  for (const Outcome& o : outcomes) {
    std::string text = "contact,mu,r_n,r_t1,r_t2\n";
    for (std::size_t i = 0; i < o.lambda.size(); ++i)
      text += fmt::format("{},{},{},{},{}\n", i, problem.mu[i], o.lambda[i].x(), o.lambda[i].y(), o.lambda[i].z());
    write_file(folder / ("solution_" + o.method + ".csv"), text);
    text = "iteration,residual\n";
    for (std::size_t i = 0; i < o.history.size(); ++i) text += fmt::format("{},{}\n", i, o.history[i]);
    write_file(folder / ("residual_" + o.method + ".csv"), text);
  }
  write_file(folder / "methods.csv", methods_table(outcomes));
}

}  // namespace

int step_command(const Arguments& arguments) {
  const auto chosen = chosen_solvers(arguments.lcp);
  const FrictionContactProblem read = read_friction_contact(arguments.a);
  const ConeProblem& problem = read.problem;
  LcpSettings settings{arguments.step_tolerance, arguments.max_iterations};
  settings.measure = Measure::siconos;
  const auto [least, most] = std::minmax_element(problem.mu.begin(), problem.mu.end());
  fmt::print("{}: {} contacts, friction {}, {} of {} blocks of W\n", arguments.a, problem.q.size(), *least == *most ? fmt::format("{}", *least) : fmt::format("{} to {}", *least, *most),
             read.w->blocks().size(), problem.q.size() * problem.q.size());
  fmt::print("{:<40}{:>11}{:>11}{:>11}{:>13}{:>9}  {}\n", "method", "iterations", "ms", "residual", "natural map", "contact", "stop");

  std::vector<Outcome> outcomes;
  std::vector<std::string> left_out;
  for (const Entry<LcpSolver>* entry : chosen) {
    if (const std::string why = entry->make()->applies(problem); !why.empty()) {
      left_out.push_back(fmt::format("{} does not apply: {}", entry->name, why));
      continue;
    }
    outcomes.push_back(solve(*entry, problem, settings, !arguments.out.empty()));
    const Outcome& o = outcomes.back();
    fmt::print("{:<40}{:>11}{:>11.2f}{:>11.2e}{:>13.2e}{:>9}  {}\n", o.method, o.result.iterations, o.ms, o.residual.siconos, o.residual.map.relative, o.residual.worst,
               name_of(o.result.reason));
    std::fflush(stdout);
  }
  for (const std::string& line : left_out) fmt::print("{}\n", line);
  if (outcomes.empty()) throw InputError(fmt::format("{}: no chosen solver applies; see impinge list lcp_solvers; choose others for --lcp", arguments.a));
  const Outcome& best = *std::min_element(outcomes.begin(), outcomes.end(), [](const Outcome& l, const Outcome& r) { return l.residual.siconos < r.residual.siconos; });
  fmt::print("smallest residual: {}, {}\n", best.method, regimes(problem, best.lambda));
  fmt::print("residual: by Siconos' definition; natural map: relative to the largest |q|, with the contact where it is worst\n");
  if (!arguments.out.empty()) write_outcomes(arguments.out, problem, outcomes);
  return 0;
}

}  // namespace impinge
