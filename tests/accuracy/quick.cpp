// The quick response against what is known without it: where friction holds, what a collision keeps, what a pile may overlap,
// and that nothing gets through.
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/mechanics/bullets.hpp"
#include "tests/support/mechanics/chains.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/pile.hpp"
#include "tests/support/mechanics/response_worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void prepare(World& world) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.parameters.response.method = "quick";
}

double deepest(const World& world) { return judge_overlap(world.bodies()).penetration; }

}  // namespace

TEST_CASE("quick: a block on an incline holds up to a thousandth of tan θ, and slides by g (sin θ - µ cos θ) beyond") {
  for (const double angle : {0.2, 0.5, 0.9})
    for (const double share : {1.001, 0.99}) {
      CAPTURE(angle, share);
      const double mu = share * std::tan(angle);
      const Vec3 normal(-std::sin(angle), std::cos(angle), 0.0), down(-std::cos(angle), -std::sin(angle), 0.0);
      World world;
      prepare(world);
      world.parameters.contact.friction = mu;
      world.add_body(fixed_plane("slope", normal, 0.0));
      BodyDescription block = dynamic_body("block", Box{Vec3(0.5, 0.1, 0.5)}, 0.1 * normal);
      block.rotation = Vec3(0, 0, angle * 180.0 / M_PI);
      world.add_body(block);
      world.start();
      run(world, 60);  // what the first frames without a warm start let slip is over
      const double before = rigid(world, 1).velocity.dot(down);
      run(world, 120);
      const double gained = rigid(world, 1).velocity.dot(down) - before;
      if (share > 1.0)
        CHECK(std::abs(rigid(world, 1).velocity.dot(down)) < 1e-6);
      else
        CHECK(gained == Approx(2.0 * 9.81 * (std::sin(angle) - mu * std::cos(angle))).epsilon(1e-3));
    }
}

TEST_CASE("quick: a heap that flies apart keeps its momentum and angular momentum to rounding") {
  World world;
  prepare(world);
  world.parameters.simulation.gravity.setZero();
  Random random(7);
  for (int i = 0; i < 27; ++i) {
    const Vec3 at = 0.55 * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    BodyDescription box = cube("box" + std::to_string(i), 0.5, at);
    box.rotation = 5.0 * random.vector();
    box.velocity = -2.0 * at + random.vector();
    box.angular_velocity = 2.0 * random.vector();
    world.add_body(box);
  }
  world.start();
  const Vec3 p = world.record().stats.momentum, l = world.record().stats.angular_momentum;
  const double mass = 27 * world.bodies()[0].mass;
  for (int i = 0; i < 60; ++i) {
    world.step();
    CHECK((world.record().stats.momentum - p).norm() < 1e-11 * mass);
    CHECK((world.record().stats.angular_momentum - l).norm() < 1e-3 * mass);
  }
}

TEST_CASE("quick: a pile of 200 boxes is never deeper in one another than 5 mm once it has come apart, and rests") {
  World world;
  prepare(world);
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  Random random(4242);
  add_pile(world, random, 200);
  world.start();
  double worst = 0.0;
  for (int i = 0; i < 240; ++i) {
    world.step();
    if (i >= 15 && i % 5 == 0) worst = std::max(worst, deepest(world));
  }
  CHECK(worst < 5e-3);
  CHECK(deepest(world) < 1e-4);
  CHECK(fastest(world) < 1e-2);
}

TEST_CASE("quick: stacks of cubes come to rest and stay where they stand for a minute, small ones too") {
  for (const double side : {1.0, 0.01})
    for (const int count : {2, 3, 5, 10}) {
      CAPTURE(side, count);
      World world;
      prepare(world);
      if (side < 0.1 && count > 5) world.parameters.simulation.substeps = 3;  // as `impinge check` advises
      world.parameters.contact.friction = 0.5;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      for (int i = 0; i < count; ++i) {
        BodyDescription box = cube("cube" + std::to_string(i), side, Vec3(0, (i + 0.5) * side, 0));
        box.mass = 1.0;
        world.add_body(box);
      }
      world.start();
      run(world, 600);
      const double falls = 9.81 * side * count;  // J, of the stack by the side of a cube
      CHECK(world.record().stats.kinetic < 1e-4 * falls);
      const Vec3 top = rigid(world, count).pose.position;
      CHECK((top - Vec3(0, (count - 0.5) * side, 0)).norm() < 0.1 * side);
      run(world, 3000);
      CHECK(world.record().stats.kinetic < 1e-7 * falls);
      CHECK((rigid(world, count).pose.position - top).norm() < 0.01 * side);
    }
}

TEST_CASE("quick: what comes up to a surface where a sub-step ends bounces all the same, with all its energy") {
  for (const int substeps : {1, 2, 3, 4, 6})
    for (const int balls : {1, 4, 10}) {
      CAPTURE(substeps, balls);
      World world;
      prepare(world);
      world.parameters.simulation.substeps = substeps;
      world.parameters.contact.restitution = 1.0;
      world.parameters.contact.friction = 0.0;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      world.add_body(fixed_plane("left", Vec3::UnitX(), -1.0));
      world.add_body(fixed_plane("right", -Vec3::UnitX(), -0.11 * balls - 0.3));
      for (int i = 0; i < balls; ++i) {
        BodyDescription ball =
            dynamic_body("ball" + std::to_string(i), Sphere{0.05}, {0.11 * i - (i == 0 ? 0.3 : 0.0), 0.05, 0});
        ball.mass = 1.0;
        if (i == 0) ball.velocity = Vec3::UnitX();
        world.add_body(ball);
      }
      world.start();
      for (int frame = 0; frame < 600; ++frame) {
        world.step();
        CHECK(world.record().stats.kinetic == Approx(0.5).epsilon(1e-9));
      }
    }
}

TEST_CASE("quick: a shot at a rack of 55 balls neither wins nor loses energy where nothing is lost") {
  for (const int substeps : {1, 4})
    for (const double gap : {1e-6, 1e-4}) {
      CAPTURE(substeps, gap);
      World world;
      prepare(world);
      world.parameters.simulation.substeps = substeps;
      world.parameters.simulation.gravity.setZero();
      world.parameters.contact.restitution = 1.0;
      world.parameters.contact.friction = 0.0;
      const auto add = [&](double x, double z, double speed) {
        BodyDescription ball =
            dynamic_body("ball" + std::to_string(world.bodies().size().value()), Sphere{0.05}, {x, 0, z});
        ball.mass = 1.0;
        ball.velocity = Vec3(speed, 0, 0);
        world.add_body(ball);
      };
      add(-0.5, 0.003, 5.0);
      for (int row = 0; row < 10; ++row)
        for (int k = 0; k <= row; ++k) add(row * (0.1 + gap) * std::sqrt(0.75), (k - 0.5 * row) * (0.1 + gap), 0.0);
      world.start();
      for (int frame = 0; frame < 60; ++frame) {
        world.step();
        CHECK(world.record().stats.kinetic == Approx(12.5).epsilon(1e-9));
      }
    }
}

TEST_CASE("quick: what rolls a radian and more in a sub-step neither sinks nor slows") {
  for (const double radius : {1e-3, 1e-2, 0.1})
    for (const bool rod : {false, true}) {
      CAPTURE(radius, rod);
      const double speed = 1.4 * radius * 60.0 * 1.5;  // slides at first; rolls by about 1.4 radians a frame
      World world;
      prepare(world);
      world.parameters.contact.friction = 5.0;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription body = dynamic_body(
          "body", rod ? SharedShape(Capsule{radius, 2.0 * radius}) : SharedShape(Sphere{radius}), {0, radius, 0});
      body.mass = 1.0;
      body.velocity = Vec3(speed, 0, 0);
      if (rod) body.rotation = Vec3(90, 0, 0);
      world.add_body(body);
      world.start();
      const double share = 1.0 / (1.0 + rigid(world, 1).world_inertia()(2, 2) / (radius * radius));  // of the speed
      run(world, 300);
      CHECK(rigid(world, 1).velocity.x() == Approx(share * speed).epsilon(0.01));
      CHECK(rigid(world, 1).pose.position.y() == Approx(radius).epsilon(0.02));
    }
}

TEST_CASE("quick: it claims no convergence where there is no answer, and none is missed where there is") {
  World world;
  prepare(world);
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(dynamic_body("ball", Sphere{0.1}, Vec3(0, 0.1, 0)));
  BodyDescription press = dynamic_body("press", Box{Vec3(0.5, 0.05, 0.5)}, Vec3(0, 0.26, 0));
  press.kind = BodyKind::scripted;
  press.motion = {{0.0, Vec3(0, 0.26, 0), {}}, {1.0, Vec3(0, 0.2, 0), {}}};
  world.add_body(press);
  world.start();
  run(world, 5);
  CHECK(world.record().stats.ended == SolveEnd::converged);
  run(world, 35);
  CHECK(world.record().stats.residual_coulomb > 0.1);
  CHECK(world.record().stats.ended == SolveEnd::fixed);
  CHECK(world.record().stats.unconverged == 0);
}

TEST_CASE("quick: piles have the same bits for 1, 2 and 4 threads, and go on from a snapshot bit for bit") {
  const auto make = [](World& world) {
    prepare(world);
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    Random random(3);
    for (int i = 0; i < 2000; ++i) {  // enough for colours that threads share
      const Vec3 at(0.205 * (i % 20), 0.1 + 0.2 * (i / 400), 0.205 * (i / 20 % 20));
      world.add_body(dynamic_body("ball" + std::to_string(i), Sphere{0.1}, at + 0.01 * random.vector()));
    }
    add_bars(world, 20, 1.0, false);  // which falls through them
    world.start();
  };
  std::vector<std::uint64_t> first;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    World world;
    make(world);
    std::vector<std::uint64_t> hashes;
    ByteWriter kept;
    for (int i = 0; i < 12; ++i) {
      if (i == 8) world.save(kept);
      world.step();
      hashes.push_back(world.record().stats.state_hash);
    }
    if (first.empty()) first = hashes;
    CHECK(world.record().stats.contacts > 3000);
    CHECK(hashes == first);
    World fresh;
    make(fresh);
    ByteReader back(kept.bytes());
    fresh.restore(back);
    for (int i = 8; i < 12; ++i) {
      fresh.step();
      CHECK(fresh.record().stats.state_hash == first[i]);
    }
  }
  set_thread_count(0);
}

TEST_CASE("quick: nothing passes a plate of 2 mm at 1 to 300 m/s, or leaves a shell") {
  std::uint64_t seed = 700;
  for (const char* mover : {"box", "hull", "cube", "icosphere"})
    for (const int substeps : {1, 4}) {
      for (const char* target : {"plate_1m", "plate_20", "foil"})
        for (const double speed : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0}) {
          const ShotResult r = shoot({mover, target, speed, substeps, ++seed, "quick"});
          INFO(mover << " on " << target << " at " << speed << ", " << substeps << " sub-steps, seed " << seed
                     << ", unsafe " << r.unsafe);
          CHECK(r.error.empty());
          // through a foil of 0.1 mm something gets from 300 m/s on, and is named
          if (std::string(target) == "foil" && speed > 100.0)
            CHECK((!r.has_passed || r.unsafe > 0));
          else
            CHECK_FALSE(r.has_passed);
        }
      const ShotResult r = shoot({mover, "shell", 30.0, substeps, ++seed, "quick"});
      INFO(mover << " in a shell, " << substeps << " sub-steps, seed " << seed);
      CHECK_FALSE(r.has_passed);
    }
}

TEST_CASE("quick: a shot runs through Newton's cradle") {
  World world;
  prepare(world);
  add_cradle(world, 0.0, 1.0);
  world.start();
  run(world, 10);
  for (int i = 0; i < 4; ++i) CHECK(std::abs(rigid(world, i).velocity.x()) < 1e-9);
  CHECK(rigid(world, 4).velocity.x() == Approx(1.0).epsilon(1e-9));
}

TEST_CASE(
    "quick: chains of a hundred links, and of a few with an end ten thousand times as heavy, hold and win nothing") {
  struct Case {
    int links;
    double ratio;
    int substeps, frames;
    double apart;  // of a link, at most
  };
  for (const bool is_rope : {false, true})
    for (const Case& c : {Case{100, 1.0, 1, 90, 0.1}, Case{100, 1.0, 4, 90, 0.1}, Case{100, 100.0, 1, 60, 0.1},
                          Case{20, 1.0, 1, 120, 0.1}, Case{8, 1e4, 1, 90, 0.15}, Case{8, 1e4, 4, 40, 0.15}}) {
      CAPTURE(is_rope, c.links, c.ratio, c.substeps);
      World world;
      settle_method(world, "quick", c.substeps);
      const double fall = add_bars(world, c.links, c.ratio, is_rope);
      world.start();
      double first = 0.0, won = 0.0, apart = 0.0;
      for (int frame = 0; frame < c.frames; ++frame) {
        world.step();
        const double energy = world.record().stats.kinetic + world.record().stats.potential;
        if (frame == 0) first = energy;
        won = std::max(won, (energy - first) / fall);
        apart = std::max(apart, widest(world) / 0.3);
      }
      CHECK(won < 0.01);
      CHECK(apart < c.apart);
    }
}

TEST_CASE(
    "quick: a chain of twenty links comes to where constraint anticipation with fine sub-steps says, to first order") {
  const auto ends = [](const std::string& method, int substeps) {
    World world;
    settle_method(world, method, substeps);
    add_bars(world, 20, 1.0, false);
    world.start();
    for (int frame = 0; frame < 40; ++frame) world.step();
    std::vector<Vec3> at;
    for (const Body& body : world.bodies()) at.push_back(body.pose.position);
    return at;
  };
  const std::vector<Vec3> truth = ends("constraint_anticipation", 64);
  for (const int substeps : {4, 16}) {
    const std::vector<Vec3> found = ends("quick", substeps);
    double error = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) error = std::max(error, (found[i] - truth[i]).norm());
    CAPTURE(substeps, error);
    CHECK(error < 0.2 / substeps);
  }
}

TEST_CASE(
    "quick: a chain held at one end that falls on the ground stays together, wins nothing and is not deep in it") {
  for (const bool is_rope : {false, true})
    for (const int substeps : {1, 4}) {
      CAPTURE(is_rope, substeps);
      World world;
      settle_method(world, "quick", substeps);
      const double fall = add_bars(world, 20, 1.0, is_rope);
      world.add_body(fixed_plane("ground", Vec3::UnitY(), -3.0));
      world.start();
      double first = 0.0;
      for (int frame = 0; frame < 180; ++frame) {
        world.step();
        const FrameStats& stats = world.record().stats;
        if (frame == 0) first = stats.kinetic + stats.potential;
        REQUIRE(stats.kinetic + stats.potential - first < 1e-6 * fall);
        REQUIRE(widest(world) < 0.05 * 0.3);
        REQUIRE(stats.max_penetration < 5e-3);
      }
    }
}
