// Fast bodies don't pass thin ones: a fixed part of the grid that bench_bullets runs.
#include "tests/support/mechanics/bullets.hpp"

#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// How many of its motions were unsafe.
std::int64_t check_stopped(const Shot& shot) {
  const ShotResult r = shoot(shot);
  INFO(shot.mover << " on " << shot.target << " at " << shot.speed << ", " << shot.substeps << " sub-steps, seed "
                  << shot.seed << ", unsafe " << r.unsafe);
  CHECK(r.error.empty());
  CHECK_FALSE(r.has_passed);
  CHECK(r.energy <= 1.0 + 1e-6);
  CHECK(r.overlap <= 1e-3 * r.thickness);
  CHECK(r.shown <= 1e-2 * r.thickness);
  return r.unsafe;
}

}  // namespace

TEST_CASE("nothing passes a plate of 2 mm, at 1 to 1,000 m/s", "[bullets]") {
  std::uint64_t seed = 100;
  for (const char* mover : {"box", "hull", "cube", "icosphere", "bunny"}) {
    if (!can_shoot(mover)) continue;
    for (const char* target : {"plate_1m", "plate_50", "plate_20", "foil"})
      for (const double speed : {1.0, 10.0, 100.0, 1000.0}) check_stopped({mover, target, speed, 4, ++seed});
    for (const double speed : {10.0, 100.0, 1000.0}) check_stopped({mover, "plate_50", speed, 1, ++seed});
  }
}

TEST_CASE("nothing leaves a closed shell of 10 mm", "[bullets]") {
  std::uint64_t seed = 200;
  for (const char* mover : {"box", "hull", "cube", "icosphere"})
    for (const double speed : {10.0, 30.0, 100.0}) check_stopped({mover, "shell", speed, 4, ++seed});
  // a corner slides from one facet to the next by half a millimetre; pieces of a sub-step that gain by little each
  for (const char* mover : {"box", "cube"}) check_stopped({mover, "shell", 1.0, 4, 16});
  for (const std::uint64_t tumbling : {3, 4}) check_stopped({"box", "shell", 1000.0, 1, tumbling});
}

TEST_CASE("what would still pass when the sub-step can't be cut any more stands still and is counted", "[bullets]") {
  int held = 0;
  // bodies that rattle in the shell at 1,000 m/s, 16 m a sub-step: each but the first two got out when motions were let go,
  // and these are held
  for (const Shot& shot : {Shot{"cube", "shell", 1000.0, 1, 10}, Shot{"cube", "shell", 1000.0, 1, 29},
                           Shot{"hull", "shell", 1000.0, 1, 14}, Shot{"cube", "shell", 1000.0, 1, 1},
                           Shot{"cube", "shell", 1000.0, 1, 14}, Shot{"bunny", "shell", 1000.0, 1, 16}}) {
    if (!can_shoot(shot.mover)) continue;
    held += check_stopped(shot) > 0 ? 1 : 0;
  }
  CHECK(held > 0);
}

TEST_CASE("a turning rod meets the post in its way, to 1,000 rad/s", "[bullets]") {
  std::uint64_t seed = 300;
  for (const char* mover : {"rod_box", "rod_mesh"})
    for (const char* target : {"post", "post_mesh"})
      for (const double speed : {10.0, 100.0, 1000.0}) check_stopped({mover, target, speed, 4, ++seed});
}

TEST_CASE("without a look at the motion the same bodies pass, and are counted", "[bullets]") {
  Shot shot{"box", "plate_20", 100.0, 4, 101};
  shot.continuous = Continuous::off;
  int passed = 0, told = 0;
  for (int i = 0; i < 5; ++i, ++shot.seed) {
    const ShotResult r = shoot(shot);
    passed += r.has_passed ? 1 : 0;
    told += r.has_passed && r.unsafe > 0 ? 1 : 0;
  }
  CHECK(passed > 0);
  CHECK(told == passed);
}

TEST_CASE("a motion in pieces has the same bits for every number of threads and after a snapshot", "[bullets]") {
  const auto make = [](World& world) {
    world.parameters.simulation.gravity.setZero();
    BodyDescription plate = dynamic_body("plate", surface(box(Vec3(0.5, 1e-3, 0.5), {10, 1, 10})), Vec3::Zero());
    plate.kind = BodyKind::fixed;
    world.add_body(plate);
    for (int i = 0; i < 4; ++i) {
      BodyDescription ball = dynamic_body("ball" + std::to_string(i), surface(icosphere(2, 0.04)),
                                          Vec3(0.2 * i - 0.3, 0.3 + 0.013 * i, 0.01 * i));
      ball.velocity = Vec3(3.0, -50.0 - 10.0 * i, 0.0);
      ball.angular_velocity = Vec3(0.0, 30.0 * i, 200.0);
      world.add_body(ball);
    }
    world.start();
  };
  World one, other;
  make(one), make(other);
  run(one, 2);
  ByteWriter kept;
  one.save(kept);
  ByteReader back(kept.bytes());
  other.restore(back);
  run(one, 3), run(other, 3);
  CHECK(one.state_hash() == other.state_hash());
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    World again;
    make(again);
    run(again, 5);
    CHECK(again.state_hash() == one.state_hash());
  }
  set_thread_count(0);
  CHECK(one.record().bodies[1].pose.position.y() > 0.0);
}
