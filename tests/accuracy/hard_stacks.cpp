// Rigid scenes on which sequential solvers fall over: unlike masses, high stacks at 1/60 s, a pile that must come to
// rest. All with the defaults of response and solver, one sub-step a frame, sleeping off. Figures of other engines are
// in tests/README.md.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include "tests/support/mechanics/pile.hpp"
#include "tests/support/median.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void prepare(World& world) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
}

void add_stack(World& world, int boxes) {
  prepare(world);
  for (int i = 0; i < boxes; ++i) world.add_body(cube("box" + std::to_string(i), 1.0, Vec3(0, i + 0.5, 0)));
}

/// Bricks in a bond, row on row.
void add_wall(World& world, int rows, int bricks) {
  prepare(world);
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < bricks; ++i)
      world.add_body(dynamic_body(fmt::format("brick{}_{}", row, i), Box{Vec3(0.1, 0.05, 0.05)},
                                  {0.2 * i + 0.1 * (row % 2), 0.1 * row + 0.05, 0.0}));
}

/// A light cube on the floor, one of `ratio` times its mass upon it.
void add_heavy_on_light(World& world, double ratio) {
  prepare(world);
  BodyDescription light = cube("light", 1.0, {0, 0.5, 0}), heavy = cube("heavy", 1.0, {0, 1.5, 0});
  light.mass = 1.0;
  heavy.mass = ratio;
  world.add_body(light);
  world.add_body(heavy);
}

/// Deepest overlap that a contact ends the frame with, m.
double overlap(const World& world) {
  double deepest = 0.0;
  for (const ContactRecord& c : world.record().contacts) deepest = std::max(deepest, -c.gap);
  return deepest;
}

/// Vertical force between the bodies before and from `first` on, N, in the last frame: what carries all above.
double force_across(const World& world, int first) {
  double sum = 0.0;
  for (const ContactRecord& c : world.record().contacts) {
    const Vec3 tangent = tangent1(c.normal);
    const Vec3 force = c.lambda.x() * c.normal + c.lambda.y() * tangent + c.lambda.z() * c.normal.cross(tangent);
    if ((c.body_a >= first) != (c.body_b >= first)) sum += (c.body_a >= first ? 1.0 : -1.0) * force.y();
  }
  return sum / world.parameters.simulation.time_step();
}

}  // namespace

TEST_CASE("a heavy box stands on a light one for ten seconds, up to 10,000 times its mass") {
  for (const double ratio : {1.0, 10.0, 100.0, 1000.0, 10000.0}) {
    CAPTURE(ratio);
    World world;
    add_heavy_on_light(world, ratio);
    world.start();
    double deepest = 0.0;
    for (int i = 0; i < 600; ++i) {
      world.step();
      deepest = std::max(deepest, overlap(world));
    }
    CHECK(deepest <= 1e-6);
    CHECK(std::abs(world.bodies()[2].pose.position.y() - 1.5) <= 1e-6);
    CHECK(tilt_degrees(world.bodies()[2]) < 1e-4);
    CHECK(world.record().stats.unconverged == 0);
  }
}

TEST_CASE("Gauss-Seidel alone drops a box of 10,000 times the mass, and says that it did not converge") {
  World world;
  add_heavy_on_light(world, 1e4);
  world.parameters.lcp.method = "projected_gauss_seidel";
  world.start();
  bool warned = false;
  for (int i = 0; i < 600; ++i) {
    world.step();
    warned = warned || world.record().stats.unconverged > 0;
  }
  CHECK(warned);
  CHECK(world.bodies()[2].pose.position.y() < 1.4);
}

TEST_CASE("every interface of a stack of ten carries what is above it") {
  World world;
  add_stack(world, 10);
  world.start();
  run(world, 120);
  std::vector<double> force(10, 0.0);
  const int frames = 60;
  for (int f = 0; f < frames; ++f) {
    world.step();
    for (int i = 0; i < 10; ++i) force[i] += force_across(world, 1 + i) / frames;
  }
  const double weight = 9.81 * world.bodies()[1].mass;
  for (int i = 0; i < 10; ++i) CHECK(force[i] == Approx((10 - i) * weight).epsilon(1e-6));
}

TEST_CASE("a stack of fifty boxes stands at 1/60 s", "[long]") {
  World world;
  add_stack(world, 50);
  world.start();
  double drift = 0.0, deepest = 0.0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    const Vec3 top = world.bodies().back().pose.position - Vec3(0, 49.5, 0);
    drift = std::max(drift, std::hypot(top.x(), top.z()));
    deepest = std::max(deepest, overlap(world));
  }
  CHECK(drift < 1e-5);
  CHECK(deepest < 1e-6);
  CHECK(std::abs(world.bodies().back().pose.position.y() - 49.5) < 1e-6);
}

TEST_CASE("a stack of a hundred boxes and a wall of bricks stand at 1/60 s, and every solve has an answer") {
  for (const bool is_wall : {false, true}) {
    CAPTURE(is_wall);
    World world;
    if (!is_wall) {
      add_stack(world, 100);
    } else {
      add_wall(world, 8, 14);
    }
    world.start();
    std::vector<Vec3> places;
    for (const Body& b : world.bodies()) places.push_back(b.pose.position);
    std::int64_t unconverged = 0, contacts = 0;
    double drift = 0.0, deepest = 0.0;
    for (int i = 0; i < 120; ++i) {
      world.step();
      unconverged += world.record().stats.unconverged;
      contacts = std::max(contacts, world.record().stats.contacts);
      deepest = std::max(deepest, overlap(world));
    }
    for (std::size_t b = 1; b < places.size(); ++b)
      drift = std::max(drift, (world.bodies()[static_cast<int>(b)].pose.position - places[b]).norm());
    CAPTURE(contacts, drift, deepest, fastest(world));
    CHECK(contacts > 300);
    CHECK(unconverged == 0);
    CHECK(drift < 1e-5);
    CHECK(deepest < 1e-6);
    CHECK(fastest(world) < 1e-4);
  }
}

TEST_CASE("of a wall of five thousand contacts every solve has an answer") {
  World world;
  add_wall(world, 14, 30);
  world.start();
  for (int i = 0; i < 4; ++i) {
    world.step();
    CAPTURE(i, world.record().stats.residual_coulomb);
    CHECK(world.record().stats.contacts > 4000);
    CHECK(world.record().stats.unconverged == 0);
    CHECK(fastest(world) < 1e-6);
  }
}

TEST_CASE("a heap of four hundred boxes falls with a residual of a thousandth at most, and says where that is all") {
  World world;
  prepare(world);
  Random random(4242);
  add_pile(world, random, 400);
  world.start();
  std::int64_t contacts = 0;
  for (int i = 1; i <= 40; ++i) {
    world.step();
    const FrameStats& stats = world.record().stats;
    contacts = std::max(contacts, stats.contacts);
    CAPTURE(i, stats.residual_coulomb);
    CHECK(stats.residual_coulomb <= 1e-3);
    CHECK((stats.unconverged > 0 || stats.residual_coulomb <= 1.01 * world.parameters.lcp.tolerance));
  }
  CHECK(contacts > 2000);
}

TEST_CASE("a pile of two hundred boxes comes to rest without sleeping", "[long]") {
  World world;
  prepare(world);
  Random random(4242);
  add_pile(world, random, 200);
  world.start();
  int still = -1;
  for (int i = 0; i < 120; ++i) {
    world.step();
    if (fastest(world) >= 1e-3)
      still = -1;
    else if (still < 0)
      still = i;
  }
  WARN("a pile of 200 boxes: every speed below 1 mm/s from frame " << still << " of 60 a second on; now "
                                                                   << fastest(world) << " m/s");
  CHECK(still >= 0);
  CHECK(overlap(world) < 1e-6);
}

TEST_CASE("a pile of a thousand boxes comes to rest, and what its solves leave is small and said", "[long]") {
  World world;
  prepare(world);
  Random random(4242);
  add_pile(world, random, 1000);
  world.start();
  std::vector<double> residuals;
  for (int i = 1; i <= 240; ++i) {
    world.step();
    const FrameStats& stats = world.record().stats;
    residuals.push_back(stats.residual_coulomb);
    CAPTURE(i, stats.residual_coulomb);
    CHECK(stats.residual_coulomb <= 1e-2);
    CHECK((stats.unconverged > 0 || stats.residual_coulomb <= 1.01 * world.parameters.lcp.tolerance));
    if (i < 200) continue;
    CHECK(fastest(world) <= 1e-6);
    CHECK(overlap(world) <= 1e-6);
  }
  CHECK(median(residuals) <= 1e-3);
}
