// Recovery from overlap moves no point faster than contact.max_push_out, however the bodies are wedged.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a ball that is wedged in a narrow groove comes out no faster than max_push_out") {
  // Between planes a degree from upright the way out is 1 / sin 1° = 57 times the overlap.
  constexpr double kRadius = 0.1, kOverlap = 0.01, kHalf = M_PI / 180.0;
  for (const double most : {0.1, 1.0, 5.0}) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.max_push_out = most;
    world.add_body(fixed_plane("left", Vec3(std::cos(kHalf), std::sin(kHalf), 0.0), 0.0));
    world.add_body(fixed_plane("right", Vec3(-std::cos(kHalf), std::sin(kHalf), 0.0), 0.0));
    const double start = (kRadius - kOverlap) / std::sin(kHalf), out = kRadius / std::sin(kHalf);
    world.add_body(dynamic_body("ball", Sphere{kRadius}, Vec3(0.0, start, 0.0)));
    world.start();
    const double dt = world.parameters.simulation.frame_time;
    double before = start, fastest = 0.0;
    const int frames = static_cast<int>((out - start) / (most * dt)) + 3;
    for (int frame = 0; frame < frames; ++frame) {
      world.step();
      const double now = rigid(world, 2).pose.position.y();
      fastest = std::max(fastest, (now - before) / dt);
      before = now;
    }
    CAPTURE(most, frames);
    CHECK(fastest <= most * (1.0 + 1e-9));
    CHECK(fastest >= 0.9 * most);
    CHECK(before == Approx(out).margin(1e-3));
    CHECK(rigid(world, 2).velocity.norm() < 1e-12);
  }
}
