#include "engine/algebra/thrifty_solver.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A of a cube's first sub-step of 10 ms, without damping.
BlockMatrix system_of_cube(World& world, double young) {
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = 1;
  world.add_body(soft_cube("cube", 1.0, 4, Vec3(0, 3, 0), {.young = young, .damping_beta = 0.0}));
  world.start();
  world.step();
  return deformable(world, 0).open_step().a;
}

struct Two {
  explicit Two(const BlockMatrix& a, std::string_view factorization)
      : iterative(make_linear_solver("conjugate_gradient")), direct(make_linear_solver(factorization)) {
    iterative->analyze(*a.pattern);
    direct->analyze(*a.pattern);
  }
  std::unique_ptr<LinearSolver> iterative, direct;
};

VecX load(const BlockMatrix& a) { return VecX::LinSpaced(a.rows(), -1.0, 1.0); }

}  // namespace

TEST_CASE("a soft body's system is iterated, a stiff one's factorized, and either is solved") {
  for (const double young : {1e4, 1e10}) {
    CAPTURE(young);
    World world;
    const BlockMatrix a = system_of_cube(world, young);
    for (const auto& entry : linear_solvers()) {
      Two two(a, entry.name);
      const bool tells = two.direct->factor_work() > 0.0;
      ThriftySolver thrifty(*two.iterative, *two.direct);
      REQUIRE(thrifty.factorize(a) == SolveStatus::ok);
      VecX x = VecX::Zero(a.rows());
      const SolveReport report = thrifty.solve(load(a), x);
      CAPTURE(std::string(entry.name));
      CHECK(report.status == SolveStatus::ok);
      CHECK((a * x - load(a)).norm() <= 1e-7 * load(a).norm());
      CHECK(two.direct->factorizations == (tells && young > 1e6 ? 1 : 0));
    }
  }
}

TEST_CASE("iterations that turn out to be too many end in a factorization") {
  World world;
  const BlockMatrix a = system_of_cube(world, 1e4);
  if (find_entry(linear_solvers(), "cholmod") == nullptr) return;  // nothing else tells what it costs
  Two two(a, "cholmod");
  ThriftySolver thrifty(*two.iterative, *two.direct);
  two.iterative->tolerance = 1e-300;  // what no iteration gets to
  REQUIRE(thrifty.factorize(a) == SolveStatus::ok);
  VecX x = VecX::Zero(a.rows());
  const SolveReport report = thrifty.solve(load(a), x);
  CHECK(report.status == SolveStatus::ok);
  CHECK(report.iterations > 0);
  CHECK(two.direct->factorizations == 1);
  CHECK((a * x - load(a)).norm() <= 1e-10 * load(a).norm());
  CHECK(two.iterative->max_iterations == 10000);
}

TEST_CASE("where a factorization is asked for one is made, for the free velocity and contact together") {
  World world;
  const BlockMatrix a = system_of_cube(world, 1e4);
  Two two(a, "automatic");
  two.iterative = make_linear_solver(two.direct->factor_work() > 0.0 ? "cholmod" : "simplicial_llt");
  two.iterative->analyze(*a.pattern);
  ThriftySolver thrifty(*two.iterative, *two.direct);
  VecX x = VecX::Zero(a.rows());
  REQUIRE(thrifty.factorize(a) == SolveStatus::ok);
  CHECK(thrifty.solve(load(a), x).status == SolveStatus::ok);
  CHECK((a * x - load(a)).norm() <= 1e-10 * load(a).norm());
  CHECK(two.iterative->factorizations + two.direct->factorizations == 1);
}
