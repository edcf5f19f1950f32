// What slides without friction from one table onto the next, which is level with it or a little lower: nothing holds it, so
// by Newton's first law it goes on at its speed, whatever shapes the two are told as. And what is in its way stops it.
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const Vec3 kTable(2.0, 0.1, 0.5), kSlider(0.25, 0.1, 0.15);  // half sizes, metres

struct Made {
  const char* name;
  SharedShape shape;
};

/// One box, told in every way.
std::vector<Made> ways_to_tell(const Vec3& half) {
  const Vec3 part(0.5 * half.x(), half.y(), half.z());
  return {{"box", Box(half)},
          {"coarse mesh", surface(box(half))},
          {"fine mesh", surface(box(half, {7, 3, 5}))},
          {"hull", made_hull(box_corners(half))},
          {"compound", made_compound({{Box(part), {Mat3::Identity(), {-part.x(), 0, 0}}},
                                      {Box(part), {Mat3::Identity(), {part.x(), 0, 0}}}})}};
}

/// What slides at `speed` along x from table to table; their tops are at 0 and `lower` below it.
struct Passing {
  double speed = 1.0, gap = 0.0, lower = 0.0, yaw = 0.0;
  int substeps = 4;
  const char* method = "constraint_anticipation";
};

struct Passed {
  double slowed = 0.0;  // the most of the speed that it loses at any time, relative
  double gained = 0.0;  // the most of kinetic energy beyond what the way down gives, relative
  double lift = 0.0;    // the fastest way up, m/s
};

Passed pass(const SharedShape& table, const SharedShape& slider, const Passing& how) {
  World world;
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = how.substeps;
  world.parameters.contact.friction = 0.0;
  use(world, how.method);
  world.add_body(fixed_body("first", table, {-kTable.x() - how.gap, -kTable.y(), 0.0}));
  world.add_body(fixed_body("second", table, {kTable.x(), -kTable.y() - how.lower, 0.0}));
  BodyDescription body = dynamic_body("slider", slider, {-0.35 - how.gap, kSlider.y(), 0.03});
  body.rotation = Vec3(0.0, how.yaw, 0.0);
  body.velocity = Vec3(how.speed, 0.0, 0.0);
  world.add_body(body);
  world.start();
  Passed worst;
  const int frames = static_cast<int>(std::ceil((0.8 + how.gap) / (how.speed / 60.0)));
  for (int i = 0; i < frames; ++i) {
    world.step();
    const Vec3& v = rigid(world, 2).velocity;
    worst.slowed = std::max(worst.slowed, 1.0 - v.x() / how.speed);
    worst.gained =
        std::max(worst.gained, (v.squaredNorm() - 2.0 * kGravity * how.lower) / (how.speed * how.speed) - 1.0);
    worst.lift = std::max(worst.lift, rigid(world, 2).velocity.y());
  }
  return worst;
}

}  // namespace

TEST_CASE("what slides from a table onto the next goes on at its speed", "[joints]") {
  for (const Made& table : ways_to_tell(kTable))
    for (const Made& slider : ways_to_tell(kSlider))
      for (const double speed : {0.3, 3.0, 30.0})
        for (const auto& [gap, lower] : {std::pair(0.0, 0.0), {1e-3, 0.0}, {1e-3, 1e-4}, {0.1, 1e-6}}) {
          // turned and not, in one step and in several: each somewhere
          const bool is_turned = (lower > 0.0) != (speed == 3.0), is_one_step = (gap == 1e-3) != (speed == 0.3);
          const Passing how{speed, gap, lower, is_turned ? 17.0 : 0.0, is_one_step ? 1 : 4};
          INFO(slider.name << " over " << table.name << ", " << speed << " m/s, gap " << gap << ", lower " << lower
                           << ", yaw " << how.yaw << ", " << how.substeps << " sub-steps");
          const Passed worst = pass(table.shape, slider.shape, how);
          CHECK(worst.slowed <= 1e-3);
          CHECK(worst.gained <= 1e-3);
          CHECK(worst.lift <= 1e-3 * speed + 1e-3);
        }
}

TEST_CASE("iterative anticipation, impulses and quick let pass what slides from a table onto the next", "[joints]") {
  for (const char* method : {"iterative_constraint_anticipation", "sequential_impulse", "quick"})
    for (const Made& table : ways_to_tell(kTable))
      for (const auto& [gap, yaw] : {std::pair(0.0, 17.0), {1e-3, 0.0}})
        for (const int substeps : {1, 4}) {
          const Passing how{3.0, gap, 1e-5, yaw, substeps, method};
          INFO(method << " over " << table.name << ", gap " << gap << ", yaw " << yaw << ", " << substeps
                      << " sub-steps");
          for (const Made& slider : ways_to_tell(kSlider)) {
            INFO(slider.name);
            CHECK(pass(table.shape, slider.shape, how).slowed <= 1e-3);
          }
        }
}

TEST_CASE("what rolls or lies round slides from a table onto the next at its speed", "[joints]") {
  const double r = kSlider.y();
  const Made round[] = {{"sphere", Sphere{r}}, {"capsule", Capsule{r, 0.15}}, {"cylinder", cylinder(r, 0.3)}};
  std::vector<Made> tables = ways_to_tell(kTable);
  tables.push_back({"disc", cylinder(kTable.x(), 2.0 * kTable.y())});
  for (const Made& table : tables)
    for (const Made& slider : round)
      for (const double gap : {0.0, 1e-3})
        for (const int substeps : {1, 4}) {
          World world;
          world.parameters.simulation.sleeping = false;
          world.parameters.simulation.substeps = substeps;
          world.parameters.contact.friction = 0.0;
          world.add_body(fixed_body("first", table.shape, {-kTable.x() - gap, -kTable.y(), 0.0}));
          world.add_body(fixed_body("second", table.shape, {kTable.x(), -kTable.y(), 0.0}));
          BodyDescription body = dynamic_body("slider", slider.shape, {-0.35, r, 0.03});
          body.rotation = Vec3(90.0, 0.0, 0.0);
          body.velocity = Vec3(3.0, 0.0, 0.0);
          world.add_body(body);
          world.start();
          double slowed = 0.0;
          for (int i = 0; i < 20; ++i)
            world.step(), slowed = std::max(slowed, std::abs(1.0 - rigid(world, 2).velocity.x() / 3.0));
          INFO(slider.name << " over " << table.name << ", gap " << gap << ", " << substeps << " sub-steps");
          CHECK(slowed <= 1e-3);
        }
}

TEST_CASE("a coin slides from a round table onto the next at its speed", "[joints]") {
  for (const double gap : {0.0, 1e-3})
    for (const double lower : {0.0, 1e-6, 1e-4})
      for (const int substeps : {1, 4}) {
        const Passing how{3.0, gap, lower, 0.0, substeps};
        const Passed worst = pass(cylinder(kTable.x(), 2.0 * kTable.y()), cylinder(0.1, 2.0 * kSlider.y()), how);
        CAPTURE(gap, lower, substeps);
        CHECK(worst.slowed <= 1e-3);
        CHECK(worst.gained <= 1e-3);
      }
}

TEST_CASE("a soft cube slides from a table onto the next at its speed", "[joints]") {
  const SoftOptions soft{1e6, 0.3, 1000.0, 0.01, "corotational"};
  for (const Made& table : ways_to_tell(kTable))
    for (const double speed : {0.3, 3.0, 10.0})
      for (const auto& [gap, lower] : {std::pair(0.0, 0.0), {1e-3, 1e-6}, {0.03, 1e-4}}) {
        World world;
        world.parameters.simulation.sleeping = false;
        world.parameters.simulation.substeps = speed == 3.0 ? 1 : 4;
        world.parameters.contact.friction = 0.0;
        world.add_body(fixed_body("first", table.shape, {-kTable.x() - gap, -kTable.y(), 0.0}));
        world.add_body(fixed_body("second", table.shape, {kTable.x(), -kTable.y() - lower, 0.0}));
        BodyDescription cube = soft_cube("cube", 0.2, 3, {-0.25 - gap, 0.0, 0.03}, soft);
        cube.velocity = Vec3(speed, 0.0, 0.0);
        world.add_body(cube);
        world.start();
        double slowed = 0.0;
        for (int i = 0; i < static_cast<int>(std::ceil((0.5 + gap) / (speed / 60.0))); ++i) {
          world.step();
          const DeformableBody& body = deformable(world, 2);
          slowed = std::max(slowed, 1.0 - body.momentum().x() / (body.mass * speed));
        }
        INFO("over " << table.name << ", " << speed << " m/s, gap " << gap << ", lower " << lower);
        CHECK(slowed <= 0.01);
      }
}

TEST_CASE(
    "a table that stands higher stops what slides against it, and so does one whose top is passed on the way down",
    "[joints]") {
  for (const Made& table : ways_to_tell(kTable))
    for (const Made& slider : ways_to_tell(kSlider))
      for (const double speed : {0.3, 3.0, 30.0})
        for (const int substeps : {1, 4}) {
          INFO(slider.name << " against " << table.name << ", " << speed << " m/s, " << substeps << " sub-steps");
          World higher;
          higher.parameters.simulation.sleeping = false;
          higher.parameters.simulation.substeps = substeps;
          higher.parameters.contact.friction = 0.0;
          higher.add_body(fixed_body("first", table.shape, {-kTable.x(), -kTable.y(), 0.0}));
          higher.add_body(fixed_body("second", table.shape, {kTable.x(), -kTable.y() + 0.05, 0.0}));
          BodyDescription body = dynamic_body("slider", slider.shape, {-0.35, kSlider.y(), 0.03});
          body.velocity = Vec3(speed, 0.0, 0.0);
          higher.add_body(body);
          higher.start();
          // a block on its way down beside the table, which drifts towards it
          World falling;
          falling.parameters.simulation.substeps = substeps;
          falling.add_body(fixed_body("table", table.shape, {kTable.x(), -kTable.y(), 0.0}));
          body.position = Vec3(-kSlider.x() - 1e-3, kSlider.y() + 0.02, 0.0);
          body.velocity = Vec3(0.03 * speed, -speed, 0.0);
          falling.add_body(body);
          falling.start();
          double deepest = 0.0;
          for (int i = 0; i < static_cast<int>(std::ceil(0.6 / (speed / 60.0))); ++i) {
            higher.step(), falling.step();
            deepest = std::max(deepest, higher.record().stats.max_penetration);
            deepest = std::max(deepest, falling.record().stats.max_penetration);
          }
          CHECK(deepest < 1e-4);
          CHECK(rigid(higher, 2).velocity.x() < 0.8 * speed);
        }
}

TEST_CASE("a box of many triangles slides off a table at its speed", "[joints]") {
  const Vec3 half(0.5, 0.1, 0.2);
  const MeshPointer table = surface(box({1.0, 0.1, 0.5}, {1, 1, 3}));  // corners on the edge that it leaves over
  for (const double speed : {1.0, 3.0, 10.0, 30.0})
    for (const int substeps : {1, 4}) {
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.parameters.contact.friction = 0.0;
      world.add_body(fixed_body("table", table, {0.0, -0.1, 0.0}));
      BodyDescription body = dynamic_body("slider", surface(box(half, {20, 4, 8})), {0.0, half.y(), 0.013});
      body.velocity = Vec3(speed, 0.0, 0.0);
      world.add_body(body);
      world.start();
      double slowed = 0.0;
      // until its middle comes over the edge, where it begins to tip
      for (int i = 0; i < static_cast<int>(0.95 / (speed / 60.0)); ++i)
        world.step(), slowed = std::max(slowed, std::abs(1.0 - rigid(world, 1).velocity.x() / speed));
      CAPTURE(speed, substeps, slowed);
      CHECK(slowed <= 1e-6);
    }
}
