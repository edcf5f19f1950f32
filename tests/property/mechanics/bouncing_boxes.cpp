// Boxes that bounce with all of their energy: what lands on one edge comes down on the other next, and rebounds from that too.
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void add_plane(World& world, const std::string& name, const Vec3& normal, double offset) {
  BodyDescription plane = fixed_plane(name.c_str(), normal, offset);
  plane.restitution = 1.0, plane.friction = 0.0;
  world.add_body(plane);
}

void add_box(World& world, const Vec3& position, const Vec3& rotation) {
  BodyDescription box = dynamic_body("b" + std::to_string(world.bodies().size()), Box(Vec3::Constant(0.08)), position);
  box.mass = 1.0, box.restitution = 1.0, box.friction = 0.0;
  box.rotation = rotation;
  world.add_body(box);
}

double energy(const World& world) { return world.record().stats.kinetic + world.record().stats.potential; }

/// Shares of the energy that are left after so many frames.
double left_of(World& world, int substeps, int frames) {
  world.parameters.simulation.substeps = substeps;
  world.parameters.simulation.sleeping = false;
  world.start();
  const double begun = energy(world);
  run(world, frames);
  return energy(world) / begun;
}

}  // namespace

TEST_CASE("a column of boxes a little aslant falls and keeps its energy at restitution 1") {
  // velocities are of half a sub-step before the pose, which is what is allowed upwards
  for (const auto& [substeps, lost] : {std::pair(1, 0.04), std::pair(2, 0.025), std::pair(4, 0.015), std::pair(8, 5e-3),
                                       std::pair(16, 2e-3), std::pair(32, 1e-3)}) {
    World world;
    add_plane(world, "floor", Vec3::UnitY(), 0.0);
    for (int i = 0; i < 3; ++i) add_box(world, Vec3(0.003 * i, 0.15 + 0.25 * i, 0.0), Vec3::Zero());
    const double left = left_of(world, substeps, 36);
    CAPTURE(substeps, left);
    CHECK(left > 1.0 - lost);
    CHECK(left < 1.0 + 0.02 / substeps);
  }
}

TEST_CASE("a dozen boxes that fly about in a room keep their energy at restitution 1") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    World world;
    Random random(seed);
    add_plane(world, "floor", Vec3::UnitY(), 0.0);
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
      add_plane(world, "wall" + std::to_string(world.bodies().size()), normal, -0.5);
    for (int i = 0; i < 12; ++i)
      add_box(world, Vec3(0.4 * (i % 2) - 0.2, 0.2 + 0.3 * (i / 4), 0.4 * (i / 2 % 2) - 0.2) + 0.02 * random.vector(),
              2.0 * random.vector());
    const double left = left_of(world, 4, 60);
    CAPTURE(seed, left);
    CHECK(left > 0.95);
    CHECK(left < 1.01);
  }
}
