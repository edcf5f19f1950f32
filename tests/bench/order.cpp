// Of which order in the time step is what moves, by kind of motion and integrator.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <string_view>

#include "engine/core/profile.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/timed_motions.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kSteps[] = {4, 8, 16, 32};
constexpr double kExact = 1e-9;  // errors below this are rounding, or a solver's tolerance

/// Whole errors by sub-steps, and the time that all of it took.
struct Line {
  std::vector<double> errors;
  double ms = 0.0;
};

Line measure(const TimedMotion& motion, std::string_view integrator, const std::vector<RowText>& settings) {
  Line line;
  for (const int substeps : kSteps) {
    TimedBy by;
    by.substeps = substeps;
    by.settings = [&](World& world) {
      world.parameters.simulation.integrator = integrator;
      for (const auto& [path, value] : settings) set(world, path, value);
    };
    const StageTimer timer(line.ms);
    line.errors.push_back(motion.error(by));
  }
  return line;
}

void print(const TimedMotion& motion, std::string_view integrator, const Line& line) {
  std::string orders;
  const std::vector<double>& e = line.errors;
  for (std::size_t i = 1; i < e.size(); ++i)
    orders += e[i] < kExact ? std::string(" exact") : fmt::format(" {:.2f}", std::log2(e[i - 1] / e[i]));
  fmt::print("| {} | {} | {:.2g} {} |{} | {} | {:.0f} |\n", motion.name, integrator, e[0], motion.unit, orders,
             e.back() < kExact ? "exact" : fmt::format("{:.1f}", observed_order(e)), line.ms);
  std::fflush(stdout);
}

std::string motion_fault(const std::string& part) {
  const auto& all = timed_motions();
  const bool is_known =
      std::any_of(all.begin(), all.end(), [&](const TimedMotion& m) { return m.name.find(part) != std::string::npos; });
  return is_known ? "" : "a part of a motion's name, as \"" + std::string(all.front().name) + "\"";
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> rows;
  std::string only;
  BenchArguments arguments(
      "bench_order",
      "Of which order in the time step is what moves, by kind of motion and integrator: errors against\n"
      "formulas, or against far finer steps, with 4, 8, 16 and 32 sub-steps of 1/60 s, and log2 of their\n"
      "ratios. Rigid bodies move alike in every integrator; that they do is looked at.");
  arguments.words("path=value", rows, row_fault,
                  "parameters of the scenes, as simulation.velocities=middle; none unless given");
  arguments.word("--only", only, motion_fault, "motions with this in their names; all unless given");
  arguments.read_or_exit(argc, argv);
  std::vector<RowText> settings;
  for (const std::string& row : rows)
    settings.emplace_back(row.substr(0, row.find('=')), row.substr(row.find('=') + 1));
  fmt::print("| motion | integrator | error, 4 sub-steps | log2 of ratios | order | ms |\n|---|---|---|---|---|---|\n");
  for (const TimedMotion& motion : timed_motions()) {
    if (motion.name.find(only) == std::string::npos) continue;
    Line first;
    for (const auto& integrator : integrators()) {
      const Line line = measure(motion, integrator.name, settings);
      if (motion.is_soft)
        print(motion, integrator.name, line);
      else if (first.errors.empty())
        print(motion, "every one", first = line);
      else if (first.errors != line.errors)
        print(motion, fmt::format("{} (differs!)", integrator.name), line);
    }
  }
}
