// What a method says of its answer against what the judge finds, which no solver computes itself.
#include <catch2/catch.hpp>

#include "engine/frozen/frozen_comparison.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A soft cube under a heavy rigid one: contacts press on one another through what bends.
FrozenStep pressed(int frame, double young) {
  World world;
  world.parameters.simulation.substeps = 4;
  BodyDescription floor = cube("floor", 1.0, {0, -0.5, 0});
  floor.kind = BodyKind::fixed;
  world.add_body(floor);
  world.add_body(soft_cube("soft", 0.1, 5, {0, 0.001, 0}, {young, 0.4, 1000.0, 0.004, "neo_hookean"}));
  BodyDescription press = dynamic_body("press", Box{Vec3(0.2, 0.05, 0.2)}, {0.05, 0.153, 0.05});
  press.mass = 30.0;
  world.add_body(press);
  world.start();
  run(world, frame - 1);
  return world.step_and_freeze();
}

}  // namespace

TEST_CASE("what sweeps stop by is the judge's residual: none claims to have converged above the tolerance") {
  int converged = 0;
  for (const double young : {3e4, 1e5})
    for (const int frame : {2, 5, 9}) {
      const FrozenStep step = pressed(frame, young);
      REQUIRE(step.contacts() > 20);
      const FrozenRuler ruler(step);
      for (const char* name : {"sequential_impulse", "simultaneous_impulse", "quick", "constraint_anticipation",
                               "iterative_constraint_anticipation"})
        for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
          World settings;
          settings.parameters.response.method = name;
          Response& response = *settings.parameters.response.method;
          if (const IterationSetting own = response.iteration_setting(); own.count != nullptr && !own.is_exact)
            *own.count += 20000;
          ResponseContext context;
          context.time_step = step.time_step;
          context.lcp.tolerance = tolerance;
          const FrozenOutcome outcome = solve_frozen(step, response, *settings.parameters.lcp.method, context);
          const double residual = ruler.judge(outcome.answers).residual;
          CAPTURE(name, young, frame, tolerance, residual, outcome.iterations);
          if (!outcome.converged) continue;
          ++converged;
          CHECK(residual <= tolerance);
        }
    }
  CHECK(converged >= 60);
}
