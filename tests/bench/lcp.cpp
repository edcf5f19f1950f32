// Every LCP solver on stacks, on a light and a heavy box, and on published problems or frozen steps.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/frozen/frozen_step_file.hpp"
#include "engine/frozen/read_friction_contact.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/response/operators/delassus_of.hpp"
#include "engine/response/response.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

using Block = BlockSparseDelassus::Block;

constexpr int kRuns = 15;
constexpr double kEnoughMs = 1000.0;  // of one method's runs

struct Row {
  std::string name;
  LcpResult result;
  Residual residual;
  std::vector<double> ms;
};

/// One more run of a method.
void run(const Entry<LcpSolver>& method, const ConeProblem& problem, const LcpSettings& settings,
         std::vector<Vec3> lambda, Row& row) {
  const auto begin = std::chrono::steady_clock::now();
  row.result = method.make()->solve(problem, settings, lambda);
  row.ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  row.residual = judge(problem, lambda);
}

/// What `automatic` takes, over the quickest method's time; 0 where it doesn't end.
double report(const std::string& name, const ConeProblem& problem, const LcpSettings& settings,
              const std::vector<Vec3>& start) {
  fmt::print("{} ({} contacts, residual at first {:.1e})\n", name, problem.q.size(),
             judge(problem, start).map.relative);
  std::vector<Row> rows;
  for (int turn = 0; turn < kRuns; ++turn) {
    std::size_t i = 0;
    for (const auto& e : lcp_solvers()) {
      if (!e.make()->applies(problem).empty()) continue;
      if (turn == 0) rows.push_back({std::string(e.name), {}, {}, {}});
      Row& row = rows[i++];
      double spent = 0.0;
      for (const double ms : row.ms) spent += ms;
      if (turn == 0 || (row.result.reason == StopReason::converged && spent < kEnoughMs))
        run(e, problem, settings, start, row);
    }
  }
  double quickest = std::numeric_limits<double>::infinity(), automatic = 0.0;
  for (const Row& row : rows) {
    const double ms = test::median(row.ms),
                 left = settings.measure == Measure::siconos ? row.residual.siconos : row.residual.map.relative;
    fmt::print("  {:<40}{:>8} iterations{:>11.3f} ms{:>11.2e}  {}\n", row.name, row.result.iterations, ms, left,
               name_of(row.result.reason));
    if (!(left <= settings.tolerance)) continue;
    quickest = std::min(quickest, ms);
    if (row.name == "automatic") automatic = ms;
  }
  fmt::print("  automatic beside the quickest: {:.2f} x, {:+.2f} ms\n", automatic / quickest, automatic - quickest);
  std::fflush(stdout);
  return automatic / quickest;
}

/// A stack of n unit boxes with four contacts between neighbours, the lowest on the ground, under gravity for one step.
FrictionContactProblem stack(int n, double top_mass) {
  FrictionContactProblem made;
  std::vector<Block> blocks;
  const auto inverse_mass = [&](int b) { return b == n - 1 ? 1.0 / top_mass : 1.0; };
  const auto arms = [](int corner, double side) {  // r x d for the rows n = y, t1 = z, t2 = x at a corner of the face
    const Vec3 r(corner & 1 ? 0.5 : -0.5, side, corner & 2 ? 0.5 : -0.5);
    Mat3 m;
    m.row(0) = r.cross(Vec3::UnitY()).transpose();
    m.row(1) = r.cross(Vec3::UnitZ()).transpose();
    m.row(2) = r.cross(Vec3::UnitX()).transpose();
    return m;
  };
  for (int i = 0; i < 4 * n; ++i)
    for (int j = 0; j < 4 * n; ++j) {
      Mat3 w = Mat3::Zero();
      for (int body = 0; body < n; ++body) {  // contact i: body i/4 from above (side -1/2), body i/4 - 1 from below
        const int a = i / 4 == body       ? 1
                      : i / 4 - 1 == body ? -1
                                          : 0,
                  b = j / 4 == body       ? 1
                      : j / 4 - 1 == body ? -1
                                          : 0;
        if (a * b == 0) continue;
        w += a * b * inverse_mass(body) *
             (Mat3::Identity() + 6.0 * arms(i % 4, -0.5 * a) * arms(j % 4, -0.5 * b).transpose());
      }
      if (!w.isZero(0.0)) blocks.push_back({i, j, w});
    }
  made.w = std::make_unique<BlockSparseDelassus>(4 * n, std::move(blocks));
  made.problem.w = made.w.get();
  for (int i = 0; i < 4 * n; ++i) {
    made.problem.q.emplace_back(i < 4 ? -9.81 / 60.0 : 0.0, i < 4 ? 0.05 : 0.0, 0.0);
    made.problem.mu.push_back(0.5);
  }
  return made;
}

std::vector<Vec3> nothing(const ConeProblem& problem) { return std::vector<Vec3>(problem.q.size(), Vec3::Zero()); }

/// Every group of a frozen step, from the λ before and from nothing.
void report_step(const std::string& path, const LcpSettings& settings, std::vector<double>& ratios) {
  const FrozenStep step = read_frozen_step(path);
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    ThawedGroup thawed = thaw(step.groups[g], step.linear_solver);
    GroupSystem& group = thawed.system;
    ConeProblem problem = make_cone_problem(group);
    if (problem.q.empty()) continue;
    const std::unique_ptr<Delassus> w = delassus_of(group);
    problem.w = w.get();
    const std::string name = fmt::format("{} group {}{}", path, g, group.deformable.empty() ? "" : ", deformable");
    ratios.push_back(report(name + ", from the step before", problem, settings, group.lambda));
    ratios.push_back(report(name + ", from nothing", problem, settings, nothing(problem)));
  }
}

void summary(const char* of, const std::vector<double>& ratios) {
  if (ratios.empty()) return;
  double logs = 0.0;
  for (const double ratio : ratios) logs += std::log(ratio);
  fmt::print("automatic beside the quickest, {} {}: geometric mean {:.2f}, at most {:.2f}\n", ratios.size(), of,
             std::exp(logs / static_cast<double>(ratios.size())), *std::max_element(ratios.begin(), ratios.end()));
}

void report_published(LcpSettings settings) {
  settings.measure = Measure::siconos;
  std::vector<double> ratios;
  for (const char* name :
       {"FrictionContact3D_1c", "FC3D_Example1", "FC3D_Example1_SBM", "NESpheres_10_1", "Confeti-ex03-Fc3D-SBM",
        "Rover1039", "Rover9770", "KaplasTower-i1061-4.hdf5", "Capsules-i100-889", "BoxesStack1-i100000-32.hdf5",
        "OneObject-i100000-499.hdf5", "RockPile_tob1"}) {
    const std::string path = test::shared_file(fmt::format("friction-contact/{}.dat", name));
    if (path.empty()) {
      fmt::print("{}: skipped, no shared data folder\n", name);
      continue;
    }
    const FrictionContactProblem read = read_friction_contact(path);
    ratios.push_back(report(name, read.problem, settings, nothing(read.problem)));
  }
  summary("published problems", ratios);
}

}  // namespace

int main(int argc, char** argv) {
  LcpSettings settings{1e-8, 2000};
  std::vector<std::string> files;
  BenchArguments arguments(
      "bench_lcp",
      "Every LCP solver on stacks, on a light and a heavy box, and on the published problems where the\n"
      "shared data folder is: iterations, milliseconds (the median of runs in turn), the residual as the\n"
      "judge finds it, and what `automatic` takes beside the quickest method that reaches the tolerance.\n"
      "With files of frozen steps (`impinge run --freeze`): their groups instead, from the λ before and\n"
      "from nothing.");
  arguments.number("tolerance", settings.tolerance, {0.0}, "of the residual, m/s");
  arguments.number("cap", settings.max_iterations, {1}, "iterations at most");
  arguments.words("step_file", files, file_fault,
                  "frozen steps, in place of the problems that are made unless any is given");
  arguments.read_or_exit(argc, argv);
  if (!files.empty()) {
    std::vector<double> ratios;
    for (const std::string& file : files) report_step(file, settings, ratios);
    summary("frozen groups", ratios);
    return 0;
  }
  const auto made = [&](const std::string& name, const ConeProblem& problem) {
    report(name, problem, settings, nothing(problem));
  };
  for (const int n : {2, 10, 50}) made(fmt::format("stack of {}", n), stack(n, 1.0).problem);
  for (const double r : {1e2, 1e4}) made(fmt::format("two boxes, the upper {} times as heavy", r), stack(2, r).problem);
  report_published(settings);
}
