// Two cards that lean against each other touch with a ridge alone. By symmetry the force there is level, and moments about
// a foot say how much friction the floor has to have: (L cos θ - t sin θ) / (2 L sin θ).
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kCardLength = 1.0, kCardThickness = 0.004, kCardWidth = 0.6;

SharedShape card(bool is_hull) {
  const Vec3 half(0.5 * kCardLength, 0.5 * kCardThickness, 0.5 * kCardWidth);
  if (!is_hull) return Box(half);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return made_hull(corners);
}

/// How far the ridge sinks in two seconds, metres.
double sunk(double angle, double friction, bool left_is_hull, bool right_is_hull) {
  World world;
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 4;
  world.parameters.contact.friction = friction;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  const double s = std::sin(angle), c = std::cos(angle);
  const Vec3 place(0.5 * (kCardLength * c + kCardThickness * s), 0.5 * (kCardLength * s + kCardThickness * c), 0.0);
  BodyDescription left = dynamic_body("left", card(left_is_hull), Vec3(-place.x(), place.y(), 0.0)),
                  right = dynamic_body("right", card(right_is_hull), place);
  left.rotation = Vec3(0, 0, angle * 180.0 / M_PI);
  right.rotation = Vec3(0, 0, -angle * 180.0 / M_PI);
  world.add_body(left);
  world.add_body(right);
  world.start();
  for (int frame = 0; frame < 120; ++frame) world.step();
  return place.y() - 0.5 * (rigid(world, 1).pose.position.y() + rigid(world, 2).pose.position.y());
}

}  // namespace

TEST_CASE("a tent of cards stands above its friction threshold and falls below it, as boxes and as hulls") {
  for (const double degrees : {40.0, 45.0, 55.0, 62.0, 75.0})
    for (const auto& [left, right] : {std::pair(false, false), std::pair(true, true), std::pair(false, true)}) {
      const double angle = degrees * M_PI / 180.0;
      const double threshold =
          (kCardLength * std::cos(angle) - kCardThickness * std::sin(angle)) / (2.0 * kCardLength * std::sin(angle));
      CAPTURE(degrees, left, right, threshold);
      CHECK(std::abs(sunk(angle, 1.03 * threshold, left, right)) < 1e-4);
      CHECK(sunk(angle, 0.97 * threshold, left, right) > 0.05);
    }
}

TEST_CASE("a box slides over the joints of a floor of boxes as over one box", "[ridge]") {
  // its edges pass those of the tiles: a ridge on a ridge, which must not hold it
  for (const double speed : {0.3, 1.0, 3.0}) {
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.contact.friction = 0.0;
    for (int i = 0; i < 40; ++i) {
      BodyDescription tile =
          dynamic_body("tile" + std::to_string(i), Box(Vec3(0.1, 0.05, 0.5)), Vec3(0.2 * i, -0.05, 0.0));
      tile.kind = BodyKind::fixed;
      world.add_body(tile);
    }
    BodyDescription crate = dynamic_body("crate", Box(Vec3::Constant(0.1)), Vec3(0.05, 0.1, 0.0));
    crate.velocity = Vec3(speed, 0.0, 0.0);
    world.add_body(crate);
    world.start();
    for (int frame = 0; frame < 120; ++frame) world.step();
    const RigidBody& body = rigid(world, 40);
    CAPTURE(speed);
    CHECK(body.pose.position.x() == Approx(0.05 + 2.0 * speed).margin(1e-6));
    CHECK(body.pose.position.y() == Approx(0.1).margin(1e-6));
  }
}
