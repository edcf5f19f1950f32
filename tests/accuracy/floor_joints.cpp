// Bodies that slide and roll over joints of a floor. Without friction nothing holds what slides, whatever edges it passes; what
// rolls up a bend loses what its angular momentum about the new place has not.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "engine/geometry/surface/thickened_surface.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A slab whose upper side is cut into cells at irregular places, all in the plane y = 0 but for `noise` below it.
MeshPointer irregular_floor(int cells, double noise, std::uint64_t seed) {
  Random r(seed);
  TriangleMesh mesh = box({2.0, 0.1, 2.0}, {cells, 1, cells});
  const double cell = 4.0 / cells;
  for (Vec3& v : mesh.vertices) {
    v.y() -= 0.1;
    const bool is_inner = v.y() > -0.05 && std::abs(v.x()) < 2.0 - 0.5 * cell && std::abs(v.z()) < 2.0 - 0.5 * cell;
    if (is_inner) v += Vec3(0.35 * cell * r.sym(), -noise * r.u(), 0.35 * cell * r.sym());
  }
  return surface(std::move(mesh));
}

struct Slider {
  const char* name;
  SharedShape shape;
  Vec3 degrees;
  double height;  // of the centre where it rests
};

std::vector<Slider> sliders() {
  const Vec3 half = Vec3::Constant(0.05), turned(0.0, 27.0, 0.0);
  const SharedShape part = Box(Vec3(0.025, 0.05, 0.05));
  return {{"sphere", Sphere{0.05}, Vec3::Zero(), 0.05},
          {"capsule", Capsule{0.03, 0.1}, {0.0, 20.0, 90.0}, 0.03},
          {"box", Box(half), Vec3::Zero(), 0.05},
          {"turned box", Box(half), turned, 0.05},
          {"hull", made_hull(box_corners(half)), turned, 0.05},
          {"mesh", surface(box(half, {4, 4, 4})), turned, 0.05},
          {"coarse mesh", surface(box(half)), turned, 0.05},
          {"compound",
           made_compound({{part, {Mat3::Identity(), {-0.025, 0, 0}}}, {part, {Mat3::Identity(), {0.025, 0, 0}}}}),
           turned, 0.05},
          {"cylinder", made("cylinder", {{"radius", 0.05}, {"length", 0.1}}), turned, 0.05},
          {"cone", made("cone", {{"radius", 0.05}, {"length", 0.1}}), turned, 0.05}};
}

struct Slide {
  double energy = 0.0,
         lift = 0.0;  // the most that the kinetic energy changes, relative; the fastest way up, of the speed
};

Slide slide(const MeshPointer& floor, const Slider& slider, double speed, int substeps) {
  World world;
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.contact.friction = 0.0;
  BodyDescription ground;
  ground.name = "floor";
  ground.kind = BodyKind::fixed;
  ground.shape = floor;
  world.add_body(ground);
  BodyDescription body = dynamic_body("slider", slider.shape, {-1.5, slider.height, -0.4});
  body.rotation = slider.degrees;
  body.velocity = speed * Vec3(1.0, 0.0, 0.1).normalized();
  world.add_body(body);
  world.start();
  const double before = world.record().stats.kinetic;
  Slide worst;
  const int frames = std::min(60, static_cast<int>(2.8 / (speed / 60.0)));
  for (int i = 0; i < frames; ++i) {
    world.step();
    worst.energy = std::max(worst.energy, std::abs(world.record().stats.kinetic / before - 1.0));
    worst.lift = std::max(worst.lift, std::abs(rigid(world, 1).velocity.y()) / speed);
  }
  return worst;
}

}  // namespace

TEST_CASE("whatever slides without friction over a floor of triangles goes on at its speed", "[joints]") {
  const std::uint64_t seed = 1;
  INFO("seed " << seed);
  for (const int cells : {7, 40, 150}) {
    const MeshPointer floor = irregular_floor(cells, 0.0, seed);
    for (const Slider& slider : sliders())
      for (const double speed : {0.3, 3.0, 30.0})
        for (const int substeps : {1, 4}) {
          INFO(slider.name << " at " << speed << " m/s over " << cells << " cells, " << substeps << " sub-steps");
          const Slide worst = slide(floor, slider, speed, substeps);
          CHECK(worst.energy <= 1e-6);
          CHECK(worst.lift <= 1e-6);
        }
  }
}

namespace {

constexpr double kRadius = 0.05, kSpeed = 5.0, kBend = 3.0;  // metres, m/s, degrees

/// Two faces that meet at x = 0, z along the joint; that of x < 0 lies in y = 0.
MeshPointer bent_track(double degrees = kBend) {
  const double far = 3.0, up = far * std::tan(degrees * M_PI / 180.0);
  TriangleMesh mesh;
  for (const auto& [x, y] : {std::pair(-far, 0.0), std::pair(0.0, 0.0), std::pair(far, up)})
    for (const double z : {-0.25, 0.25}) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};  // seen from above
  return surface(thickened(mesh, {SurfaceSides::front, 0.02}));
}

struct Rolled {
  double lost = 0.0;  // of the energy
  double hop = 0.0;   // metres, over the faces
  double sway = 0.0;  // rad/s, across its axis
};

/// Rolls from `start` on over the joint, 0.6 m far.
Rolled roll_over(World& world, SharedShape wheel, const Vec3& degrees, double start, int substeps) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.contact.friction = 0.8;
  BodyDescription body = dynamic_body("wheel", std::move(wheel), {start, kRadius, 0.0});
  body.rotation = degrees;
  body.velocity = {kSpeed, 0.0, 0.0};
  body.angular_velocity = {0.0, 0.0, -kSpeed / kRadius};
  const int place = static_cast<int>(world.bodies().size().value());
  world.add_body(body);
  world.start();
  const auto energy = [&] { return world.record().stats.kinetic + world.record().stats.potential; };
  const double before = energy(), kinetic = world.record().stats.kinetic, angle = kBend * M_PI / 180.0;
  Rolled worst;
  for (int frame = 0; frame < 8; ++frame) {
    world.step();
    const RigidBody& now = rigid(world, place);
    const Vec3& x = now.pose.position;
    const double over = x.x() > 0.0 ? x.y() * std::cos(angle) - x.x() * std::sin(angle) : x.y();
    worst.hop = std::max(worst.hop, over - kRadius);
    const Vec3 spin = now.angular_velocity();
    worst.sway = std::max(worst.sway, std::hypot(spin.x(), spin.y()));
  }
  REQUIRE(rigid(world, place).pose.position.x() > 0.1);
  worst.lost = (before - energy()) / kinetic;
  return worst;
}

/// By the angular momentum about the place where it comes to touch, of what rolls with I = `inertia` m r².
double lost_at_bend(double inertia) {
  const double kept = (inertia + std::cos(kBend * M_PI / 180.0)) / (1.0 + inertia);
  return 1.0 - kept * kept;
}

}  // namespace

TEST_CASE("a ball that rolls up a bend of triangles loses what the bend takes, wherever its sub-steps end",
          "[joints]") {
  for (const int substeps : {1, 2, 4, 8, 16})
    for (int phase = 0; phase < 12; ++phase) {
      World world;
      world.add_body(fixed_body("track", bent_track()));
      const Rolled r = roll_over(world, Sphere{kRadius}, Vec3::Zero(), -0.3 + 0.0069 * phase, substeps);
      INFO(substeps << " sub-steps, phase " << phase << ": lost " << r.lost << ", hop " << r.hop << ", bend "
                    << lost_at_bend(0.4));
      CHECK(r.lost > 0.5 * lost_at_bend(0.4));
      CHECK(r.lost < 0.006);
      CHECK(r.hop < 1e-3);
    }
}

TEST_CASE("a wheel or rod that rolls up a bend of triangles loses what the bend takes, and doesn't sway", "[joints]") {
  for (const auto& [shape, length] :
       {std::pair("cylinder", 0.04), std::pair("cylinder", 0.2), std::pair("capsule", 0.1)})
    for (const int substeps : {1, 2, 4, 8, 16})
      for (int phase = 0; phase < 12; ++phase) {
        World world;
        world.add_body(fixed_body("track", bent_track()));
        const Rolled r = roll_over(world, made(shape, {{"radius", kRadius}, {"length", length}}), {90.0, 0.0, 0.0},
                                   -0.3 + 0.0069 * phase, substeps);
        INFO(shape << " of " << length << " m, " << substeps << " sub-steps, phase " << phase << ": lost " << r.lost
                   << ", hop " << r.hop << ", sway " << r.sway << ", bend " << lost_at_bend(0.5));
        CHECK(r.lost > 0.5 * lost_at_bend(0.5));
        CHECK(r.lost < 0.006);
        CHECK(r.hop < 1e-3);
        CHECK(r.sway < 1e-3);
      }
}

TEST_CASE("what is round and slides without friction over a bend doesn't begin to spin", "[joints]") {
  for (const char* shape : {"cylinder", "capsule"})
    for (const double bend : {5.0, 20.0})
      for (const int substeps : {1, 4}) {
        World world;
        world.parameters.simulation.sleeping = false;
        world.parameters.simulation.substeps = substeps;
        world.parameters.contact.friction = 0.0;
        world.add_body(fixed_body("track", bent_track(bend)));
        BodyDescription body =
            dynamic_body("round", made(shape, {{"radius", 0.1}, {"length", 0.1}}), Vec3(-0.3, 0.1, 0.0));
        body.rotation = Vec3(90.0, 0.0, 0.0);
        body.velocity = Vec3(3.0, 0.0, 0.0);
        world.add_body(body);
        world.start();
        for (int frame = 0; frame < 16; ++frame) world.step();
        CAPTURE(shape, bend, substeps);
        REQUIRE(rigid(world, 1).pose.position.x() > 0.1);
        CHECK(rigid(world, 1).angular_velocity().norm() < 1e-6);  // rad/s; by rows at its material it was 0.2 to 2.2
      }
}

TEST_CASE("a wheel that rolls from a floor onto a ramp flush with it goes on, and doesn't sway", "[joints]") {
  const double angle = kBend * M_PI / 180.0, half = 1.5, thick = 0.1;
  for (const int substeps : {2, 4, 8, 16})
    for (int phase = 0; phase < 12; ++phase) {
      World world;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription ramp = fixed_body(
          "ramp", Box(Vec3(half, thick, 0.5)),
          {half * std::cos(angle) + thick * std::sin(angle), half * std::sin(angle) - thick * std::cos(angle), 0.0});
      ramp.rotation = {0.0, 0.0, kBend};
      world.add_body(ramp);
      const Rolled r = roll_over(world, made("cylinder", {{"radius", kRadius}, {"length", 0.04}}), {90.0, 0.0, 0.0},
                                 -0.3 + 0.0069 * phase, substeps);
      INFO(substeps << " sub-steps, phase " << phase << ": lost " << r.lost << ", hop " << r.hop << ", sway " << r.sway
                    << ", bend " << lost_at_bend(0.5));
      CHECK(r.lost > 0.0);
      CHECK(r.lost < (substeps == 2 ? 0.025 : 0.006));
      CHECK(r.sway < 1e-3);
    }
}

TEST_CASE("a ball that starts a little deep in a floor comes out of it as it rolls, and no faster", "[joints]") {
  for (const int substeps : {1, 2, 4, 8})
    for (const double depth : {1e-5, 1e-4, 5e-4, 2e-3}) {
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.add_body(fixed_body("floor", Box(Vec3(3.0, 0.1, 0.5)), {0.0, -0.1, 0.0}));
      BodyDescription ball = dynamic_body("ball", Sphere{kRadius}, {-1.0, kRadius - depth, 0.0});
      ball.velocity = {kSpeed, 0.0, 0.0};
      ball.angular_velocity = {0.0, 0.0, -kSpeed / kRadius};
      world.add_body(ball);
      world.start();
      const double kinetic = world.record().stats.kinetic;
      double highest = 0.0;
      for (int frame = 0; frame < 20; ++frame) {
        world.step();
        highest = std::max(highest, rigid(world, 1).pose.position.y() - kRadius);
      }
      INFO(substeps << " sub-steps, " << depth << " deep: up to " << highest << ", energy "
                    << world.record().stats.kinetic / kinetic - 1.0);
      CHECK(highest < 1e-6);
      CHECK(world.record().stats.kinetic == Approx(kinetic).epsilon(1e-3));
    }
}
