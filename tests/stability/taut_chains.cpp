// What is light and pulled taut: ropes of bars and chains of rings under ends that are far heavier. Across the pull they swing
// faster than sub-steps see, and must neither tremble nor come apart; what swings as a whole is a pendulum.
#include <catch2/catch.hpp>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kLength = 0.1;  // metres, of a bar
constexpr double kBend = 1e-6;   // metres: they lie on one line, all but for what tells a tremble from nothing
constexpr int kBars = 10;

/// A rope of bars of 1 kg that hangs on a point of the world, straight, `angle` radians off the vertical, with a last one of
/// `load` kilograms.
void add_rope(World& world, double load, double angle) {
  const Vec3 along(std::sin(angle), -std::cos(angle), 0.0);
  for (int i = 0; i < kBars; ++i) {
    BodyDescription bar =
        dynamic_body("bar" + std::to_string(i), Box(Vec3(0.01, 0.45 * kLength, 0.01)), (i + 0.5) * kLength * along);
    bar.position += (i % 2) * kBend * Vec3(along.y(), -along.x(), 0.0);
    bar.rotation = Vec3(0.0, 0.0, angle * 180.0 / M_PI);
    bar.density *= (i == kBars - 1 ? load : 1.0) / (1000.0 * 0.02 * 0.9 * kLength * 0.02);
    world.add_body(bar);
    AttachmentDescription pin{"pin" + std::to_string(i), "bar" + std::to_string(i),
                              i > 0 ? "bar" + std::to_string(i - 1) : "", i * kLength * along};
    pin.collide = false;
    world.add_attachment(pin);
  }
  world.parameters.simulation.sleeping = false;
}

double energy_of_rope(const World& world) { return world.record().stats.kinetic + world.record().stats.potential; }

}  // namespace

TEST_CASE("a rope hangs still whatever hangs on it") {
  for (const double load : {1.0, 300.0, 1e4, 1e6})
    for (const int substeps : {1, 4}) {
      World world;
      world.parameters.simulation.substeps = substeps;
      add_rope(world, load, 0.0);
      world.start();
      for (int frame = 0; frame < 120; ++frame) world.step();
      CAPTURE(load, substeps);
      // J, some times what the pull makes of a bend of a micrometre; of bars that trembled it was 5
      CHECK(world.record().stats.kinetic < 10.0 * load * kGravity * kBend * kBend / kLength);
      CHECK(world.record().stats.unconverged == 0);
      for (int i = 0; i < kBars; ++i) CHECK(std::abs(world.bodies()[i].pose.position.x()) < 1e-5);
    }
}

TEST_CASE("a light rope swings as the pendulum of what hangs on it") {
  constexpr double kAngle = 0.5;
  const double length = (kBars - 0.5) * kLength,
               period = 2.0 * M_PI * std::sqrt(length / kGravity) *
                        (1.0 + kAngle * kAngle / 16.0 + 11.0 * std::pow(kAngle, 4) / 3072.0);
  for (const double load : {1e4, 1e6})
    for (const int substeps : {1, 4}) {
      World world;
      world.parameters.simulation.substeps = substeps;
      add_rope(world, load, kAngle);
      world.start();
      const double before = energy_of_rope(world), fall = load * kGravity * length * (1.0 - std::cos(kAngle));
      double last = world.bodies()[kBars - 1].pose.position.x(), apart = 0.0;
      std::vector<double> passes;  // seconds, through the lowest place, to the left
      for (int frame = 0; frame < 600; ++frame) {
        world.step();
        const double now = world.bodies()[kBars - 1].pose.position.x();
        if (last > 0.0 && now <= 0.0) passes.push_back((frame + last / (last - now)) / 60.0);
        last = now;
        for (const AttachmentRecord& pin : world.record().attachments)
          apart = std::max(apart, (pin.point_a - pin.point_b).norm());
      }
      CAPTURE(load, substeps);
      REQUIRE(passes.size() == 5);
      CHECK((passes.back() - passes.front()) / 4.0 == Approx(period).epsilon(2e-3));
      CHECK(std::abs(energy_of_rope(world) - before) < 0.01 * fall);
      CHECK(apart < 1e-3 * kLength);
    }
}

TEST_CASE("rings that hang in one another hang still under one that is far heavier") {
  const double major = 0.05, minor = 0.008, apart = 2.0 * (major - minor) - 1e-7;
  const MeshPointer ring = surface(torus(major, minor, 48, 16));
  for (const double load : {1.0, 300.0, 3000.0}) {
    World world;
    world.parameters.simulation.sleeping = false;
    for (int i = 0; i < 7; ++i) {
      BodyDescription d =
          i > 0 ? dynamic_body("ring" + std::to_string(i), ring, Vec3::Zero()) : fixed_body("ring0", ring);
      d.position = Vec3(0.0, -i * apart, 0.0);
      d.rotation = Vec3(90.0, i % 2 == 0 ? 0.0 : 90.0, 0.0);
      if (i == 6) d.density *= load;
      world.add_body(d);
    }
    world.start();
    double deepest = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
      world.step();
      deepest = std::max(deepest, world.record().stats.substep_penetration);
    }
    CAPTURE(load, deepest);
    CHECK(deepest < 1e-3 * minor);
    CHECK(world.record().stats.unsafe_motions == 0);
    for (int i = 1; i < 7; ++i) {
      const RigidBody& body = rigid(world, i);
      CHECK(body.fastest_point() < 1e-3);
      CHECK((body.pose.position - Vec3(0.0, -i * apart, 0.0)).norm() < 1e-3 * major);
    }
  }
}
