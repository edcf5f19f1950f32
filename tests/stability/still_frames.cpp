// Frames in which nothing moves are not made again, and nobody can tell: held against a world that somebody watches, in
// which every frame is made in full.
#include <catch2/catch.hpp>

#include "engine/core/parameter.hpp"
#include "engine/step/step_watcher.hpp"
#include "engine/world/figures.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A step each of them makes; true if all that is published is the same, times apart.
bool step_alike(World& world, World& full) {
  world.step();
  full.step();
  const StepRecord &a = world.record(), &b = full.record();
  bool same = a.stats.state_hash == b.stats.state_hash && world.state_hash() == a.stats.state_hash &&
              a.bodies.size() == b.bodies.size() && a.contacts.size() == b.contacts.size() &&
              a.broad_pairs.size() == b.broad_pairs.size();
  for (const Figure& figure : figures())
    if (figure.kind != FigureKind::time) same = same && figure.value(a.stats) == figure.value(b.stats);
  for (std::size_t i = 0; same && i < a.bodies.size(); ++i)
    same = a.bodies[i].pose.position == b.bodies[i].pose.position && a.bodies[i].asleep == b.bodies[i].asleep &&
           a.bodies[i].velocity == b.bodies[i].velocity;
  return same;
}

}  // namespace

TEST_CASE("a world asleep goes on as if every frame were made in full, and wakes at the same one") {
  const auto make = [](World& world) {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    for (int i = 0; i < 4; ++i) world.add_body(cube("box" + std::to_string(i), 0.2, {0.5 * i, 0.1, 0}));
    world.add_body(soft_cube("soft", 0.2, 2, {-1, 0.0005, 0}, {1e5, 0.4, 1000.0, 0.02}));
    BodyDescription paddle = cube("paddle", 0.2, {0.5, 0.1, 3});
    paddle.kind = BodyKind::scripted;
    paddle.motion = {
        {0.0, {0.5, 0.1, 3}, {0, 0, 0}}, {4.0, {0.5, 0.1, 3}, {0, 0, 0}}, {5.0, {0.5, 0.1, 0.1}, {0, 0, 0}}};
    world.add_body(paddle);
    world.start();
  };
  World world, full;
  StepWatcher watcher;
  full.watch(&watcher);
  make(world);
  make(full);
  int different = 0, still = 0, woken = 0;
  for (int frame = 1; frame <= 420; ++frame) {
    different += !step_alike(world, full);
    const int asleep = world.record().stats.asleep;
    still += asleep == 5;
    if (still > 30 && asleep < 5) ++woken;
  }
  CHECK(different == 0);
  CHECK(still > 60);
  CHECK(woken > 0);
}

TEST_CASE("a parameter, a body's row and a snapshot end a row of still frames") {
  World world;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
  world.add_body(cube("box", 0.2, {0, 0.1, 0}));
  world.start();
  run(world, 120);
  REQUIRE(world.bodies()[1].asleep);
  ByteWriter saved;
  world.save(saved);
  run(world, 5);
  const std::uint64_t later = world.record().stats.state_hash;

  ByteReader in(saved.bytes());
  world.restore(in);
  CHECK(world.frame() == 120);
  run(world, 5);
  CHECK(world.record().stats.state_hash == later);

  ParameterSet rows;
  world.bind_bodies(rows);
  rows.find("body.box.velocity")->set(Vec3(0, 3, 0));
  world.parameters_changed();
  world.step();
  CHECK(world.record().bodies[1].pose.position.y() > 0.12);
  run(world, 240);
  REQUIRE(world.bodies()[1].asleep);
  world.parameters.simulation.gravity = Vec3(0, 5, 0);
  world.parameters_changed();
  run(world, 10);
  CHECK(world.record().bodies[1].pose.position.y() > 0.11);
}
