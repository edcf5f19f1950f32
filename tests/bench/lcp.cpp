// bench_lcp [TOLERANCE [CAP]]: every LCP solver on chains, grids and random problems, and on the published ones where
// the shared data folder is: iterations, milliseconds, and the residual as the judge finds it.
#include <fmt/format.h>

#include <chrono>

#include "engine/frozen/read_friction_contact.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

using Block = BlockSparseDelassus::Block;

void report(const std::string& name, const ConeProblem& problem, Measure measure, double tolerance, int cap) {
  fmt::print("{} ({} contacts)\n", name, problem.q.size());
  for (const auto& e : lcp_solvers()) {
    const auto solver = e.make();
    if (!solver->applies(problem).empty()) continue;
    std::vector<Vec3> lambda(problem.q.size(), Vec3::Zero());
    LcpSettings settings{tolerance, cap};
    settings.measure = measure;
    const auto begin = std::chrono::steady_clock::now();
    const LcpResult result = solver->solve(problem, settings, lambda);
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    const Residual r = judge(problem, lambda);
    fmt::print("  {:<40}{:>8} iterations{:>11.2f} ms{:>11.2e}  {}\n", e.name, result.iterations, ms,
               measure == Measure::siconos ? r.siconos : r.map.relative, name_of(result.reason));
  }
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

}  // namespace

int main(int count, char** words) {
  const double tolerance = count > 1 ? std::atof(words[1]) : 1e-8;
  const int cap = count > 2 ? std::atoi(words[2]) : 2000;
  for (const int n : {2, 10, 50})
    report(fmt::format("stack of {}", n), stack(n, 1.0).problem, Measure::natural_map, tolerance, cap);
  for (const double r : {1e2, 1e4})
    report(fmt::format("two boxes, the upper {} times as heavy", r), stack(2, r).problem, Measure::natural_map,
           tolerance, cap);
  for (const char* name :
       {"NESpheres_10_1", "Confeti-ex03-Fc3D-SBM", "Rover1039", "Rover9770", "KaplasTower-i1061-4.hdf5",
        "Capsules-i100-889", "BoxesStack1-i100000-32.hdf5", "OneObject-i100000-499.hdf5", "RockPile_tob1"}) {
    const std::string path = test::shared_file(fmt::format("friction-contact/{}.dat", name));
    if (path.empty())
      fmt::print("{}: skipped, no shared data folder\n", name);
    else
      report(name, read_friction_contact(path).problem, Measure::siconos, tolerance, cap);
  }
}
