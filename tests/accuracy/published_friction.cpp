// Friction-contact problems that others published, solved to Siconos' residual; the solver is held against the
// iterations that plain Gauss-Seidel needs. Runs where the shared data folder is.
#include <catch2/catch.hpp>

#include "engine/frozen/read_friction_contact.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Solved {
  LcpResult result;
  Residual residual;
};

Solved solve(const FrictionContactProblem& read, const char* method, double tolerance, int cap,
             Measure measure = Measure::siconos) {
  std::vector<Vec3> lambda(read.problem.q.size(), Vec3::Zero());
  LcpSettings settings{tolerance, cap};
  settings.measure = measure;
  const LcpResult result = make_named(lcp_solvers(), method)->solve(read.problem, settings, lambda);
  return {result, judge(read.problem, lambda)};
}

std::string published(const std::string& name) {
  const std::string path = shared_file("friction-contact/" + name + ".dat");
  if (path.empty()) WARN("skipped: the shared data folder has no friction-contact/" + name + ".dat");
  return path;
}

}  // namespace

TEST_CASE("published problems: Newton reaches 1e-8 on every one in fewer iterations than Gauss-Seidel") {
  // name, sweeps of plain Gauss-Seidel to 1e-8 as measured by a program of its own; 0: not reached
  const std::tuple<const char*, int, int> table[] = {{"NESpheres_10_1", 9, 19},
                                                     {"Confeti-ex03-Fc3D-SBM", 54, 40},
                                                     {"Rover1039", 4, 14},
                                                     {"Rover9770", 5, 9},
                                                     {"KaplasTower-i1061-4.hdf5", 570, 1060},
                                                     {"Capsules-i100-889", 276, 3310},
                                                     {"BoxesStack1-i100000-32.hdf5", 52, 258731},
                                                     {"OneObject-i100000-499.hdf5", 24, 1661}};
  for (const auto& [name, contacts, sweeps] : table) {
    const std::string path = published(name);
    if (path.empty()) continue;
    const FrictionContactProblem read = read_friction_contact(path);
    REQUIRE(read.problem.q.size() == std::size_t(contacts));
    const Solved newton = solve(read, "semismooth_newton", 1e-8, 2000);
    CAPTURE(name, newton.result.iterations, newton.residual.siconos);
    CHECK(newton.result.reason == StopReason::converged);
    CHECK(newton.residual.siconos <= 1e-8);
    CHECK(newton.residual.cone.relative <= 1e-12);
    CHECK(newton.result.iterations < sweeps);
  }
}

TEST_CASE("published problems: Gauss-Seidel takes no more sweeps than was published, and claims no more than it did") {
  const std::pair<const char*, int> table[] = {
      {"NESpheres_10_1", 19}, {"Confeti-ex03-Fc3D-SBM", 40},      {"Rover1039", 14},
      {"Rover9770", 9},       {"KaplasTower-i1061-4.hdf5", 1060}, {"Capsules-i100-889", 3320}};
  for (const auto& [name, sweeps] : table) {
    const std::string path = published(name);
    if (path.empty()) continue;
    const Solved sweep = solve(read_friction_contact(path), "projected_gauss_seidel", 1e-8, sweeps);
    CAPTURE(name, sweep.result.iterations, sweep.residual.siconos);
    CHECK(sweep.result.reason == StopReason::converged);
    CHECK(sweep.residual.siconos <= 1e-8);
  }
  const std::string path = published("OneObject-i100000-499.hdf5");
  if (path.empty()) return;
  const Solved stuck = solve(read_friction_contact(path), "projected_gauss_seidel", 1e-8, 500);
  CHECK(stuck.result.solved() == (stuck.residual.siconos <= 1e-8));
}

TEST_CASE("published problems: the default reaches 1e-8 on every one, in either measure") {
  const char* const table[] = {"FrictionContact3D_1c",
                               "FC3D_Example1",
                               "FC3D_Example1_SBM",
                               "NESpheres_10_1",
                               "Confeti-ex03-Fc3D-SBM",
                               "Rover1039",
                               "Rover9770",
                               "KaplasTower-i1061-4.hdf5",
                               "Capsules-i100-889",
                               "BoxesStack1-i100000-32.hdf5",
                               "OneObject-i100000-499.hdf5"};
  for (const char* name : table) {
    const std::string path = published(name);
    if (path.empty()) continue;
    const FrictionContactProblem read = read_friction_contact(path);
    const Solved asked = solve(read, "automatic", 1e-8, 2000);
    CAPTURE(name, asked.result.iterations, asked.residual.siconos);
    CHECK(asked.result.reason == StopReason::converged);
    CHECK(asked.residual.siconos <= 1e-8);
    // the natural map has units of its own: 1e-8 of Siconos' may be 1e-4 of it, never the other way round here
    const Solved strict = solve(read, "automatic", 1e-8, 2000, Measure::natural_map);
    CAPTURE(strict.result.iterations, strict.residual.siconos, strict.residual.map.relative);
    CHECK(strict.result.reason == StopReason::converged);
    CHECK(strict.residual.siconos <= 1e-8);
    CHECK(strict.residual.map.relative <= 1e-6);
  }
}

TEST_CASE("published problems: RockPile, where Gauss-Seidel gets stuck, to 1e-6", "[long]") {
  const std::string path = published("RockPile_tob1");
  if (path.empty()) return;
  const Solved newton = solve(read_friction_contact(path), "semismooth_newton", 1e-6, 2000);
  CAPTURE(newton.result.iterations, newton.residual.siconos);
  CHECK(newton.result.reason == StopReason::converged);
  CHECK(newton.residual.siconos <= 1e-6);
}
