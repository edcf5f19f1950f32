// Self-crossings, counted over all pairs of triangles that share no vertex.
#include "engine/world/self_crossings.hpp"

#include <catch2/catch.hpp>

#include "engine/world/frame_judge.hpp"
#include "tests/support/mechanics/brute_self_crossings.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A strip along x from 0 to 1 m, bent round z by `angle` at its end: beyond a full turn it crosses itself.
void bend(Body& body, double angle) {
  const double radius = 1.0 / angle;
  for (Vec3& x : body.world_vertices) {
    const double a = x.x() * angle, r = radius - x.y();
    x = Vec3(r * std::sin(a), radius - r * std::cos(a), x.z());
  }
}

}  // namespace

TEST_CASE("crossings of a body's own surface are those of all its triangle pairs") {
  int crossed = 0;
  for (const double angle : {0.1, 3.0, 6.0, 6.3, 6.6, 8.0, 12.0}) {
    World world;
    Body& strip = world.add_body(soft_box("strip", {1.0, 0.05, 0.1}, {20, 1, 2}, Vec3::Zero()));
    bend(strip, angle);
    const std::int64_t truth = brute_self_crossings(strip);
    CAPTURE(angle, truth);
    CHECK(count_self_crossings(world.bodies()) == truth);
    CHECK((truth > 0) == (angle > 2.0 * M_PI - 0.1));
    crossed += truth > 0 ? 1 : 0;
  }
  CHECK(crossed >= 3);
}

TEST_CASE("noise on a surface is counted pair by pair, and every body counts") {
  Random random(31);
  World world;
  std::int64_t truth = 0;
  for (const char* name : {"a", "b"}) {
    Body& body = world.add_body(soft_cube(name, 1.0, 4, Vec3::Zero()));
    for (Vec3& x : body.world_vertices) x += 0.3 * random.vector();
    truth += brute_self_crossings(body);
  }
  CHECK(truth > 50);
  CHECK(count_self_crossings(world.bodies()) == truth);
}

TEST_CASE("a rigid body has none, and neither has one body within another") {
  World world;
  world.add_body(dynamic_body("mesh", surface(box({0.5, 0.5, 0.5})), Vec3::Zero()));
  world.add_body(soft_cube("soft", 1.0, 2, Vec3::Zero()));
  CHECK(count_self_crossings(world.bodies()) == 0);
}

TEST_CASE("the judge of sub-steps sees what a frame's end has got over") {
  // a ball dips into the floor in the middle of a frame: bodies are placed as a sub-step would leave them
  World world;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  Body& ball = world.add_body(dynamic_body("ball", Sphere{0.5}, {0, 0.6, 0}));
  for (const auto when : {FrameJudge::each_frame, FrameJudge::each_substep}) {
    FrameJudge judge(when);
    FrameStats stats;
    const double heights[] = {0.6, 0.45, 0.4, 0.55};
    for (int k = 0; k < 4; ++k) {
      ball.pose.position.y() = heights[k];
      judge.finished(world.bodies(), k + 1);
    }
    judge.judge(world.bodies(), stats);
    if (when == FrameJudge::each_frame) {
      CHECK(stats.judged_penetration == 0.0);
      CHECK(stats.crossing.depth == 0.0);
    } else {
      CHECK(stats.judged_penetration == Approx(0.1));
      CHECK(stats.crossing.a == "floor");
      CHECK(stats.crossing.b == "ball");
      CHECK(stats.crossing.depth == Approx(0.1));
      CHECK(stats.crossing.thickness == Approx(1.0));
      CHECK(stats.crossing.substep == 3);
    }
    // the next frame begins anew
    judge.judge(world.bodies(), stats);
    CHECK(stats.judged_penetration == 0.0);
  }
}
