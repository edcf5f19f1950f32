// Where slides come to their limits: masses, speeds, arms and starts by decades.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/slides.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Seen {
  double off = 0.0, energy = 0.0, momentum = 0.0, spin = 0.0;
  std::int64_t unconverged = 0;
};

/// How far a world's figures come from those of its start.
Seen watch(World& world, double seconds, double momentum, double energy) {
  const FrameStats start = world.record().stats;
  Seen seen;
  const int frames = static_cast<int>(std::lround(60.0 * seconds));
  for (int i = 0; i < frames; ++i) {
    world.step();
    const FrameStats& s = world.record().stats;
    seen.off = std::max(seen.off, s.attachment_error);
    seen.energy = std::max(seen.energy, std::abs(energy_of(world) - start.kinetic - start.potential) / energy);
    seen.momentum = std::max(seen.momentum, (s.momentum - start.momentum).norm() / momentum);
    seen.spin = std::max(seen.spin, (s.angular_momentum - start.angular_momentum).norm() / momentum);
    seen.unconverged += s.unconverged;
  }
  return seen;
}

}  // namespace

// Measured over three seconds: off by 2.5e-5 m, energy by 4e-4, momentum and spin by 4e-15, whatever the ratio.
TEST_CASE(
    "what slides on a free body of 1e-6 to 1e6 times the mass stays there and keeps both bodies' momentum and spin") {
  for (const auto& response : responses())
    for (const double ratio : {1e-6, 1e-3, 1.0, 1e2, 1e4, 1e6})
      for (const AttachmentKind kind : {AttachmentKind::line, AttachmentKind::plane, AttachmentKind::surface}) {
        World world;
        prepare_slides(world, Vec3::Zero());
        use(world, response.name);
        BodyDescription bead = cube("bead", 0.05, {0.06, 0.08, 0.0});
        bead.mass = ratio;
        bead.velocity = {0.4, -0.3, 0.2};  // along the ball
        BodyDescription carrier = dynamic_body("carrier", Sphere{0.1}, Vec3::Zero());
        carrier.mass = 1.0;
        world.add_body(bead);
        world.add_body(carrier);
        world.add_attachment(slide(kind, "bead", "carrier", bead.position,
                                   kind == AttachmentKind::line ? bead.velocity : Vec3(0.6, 0.8, 0.0)));
        world.start();
        const Seen s = watch(world, 3.0, ratio * bead.velocity.norm(), energy_of(world));
        CAPTURE(response.name, ratio, static_cast<int>(kind), s.off, s.energy, s.momentum, s.spin);
        CHECK(s.off < 1e-4);
        CHECK(s.energy < 2e-3);
        CHECK(s.momentum < 1e-12);
        CHECK(s.spin < 1e-12);
      }
}

// Off by half the square of what it turns in a sub-step, of the radius. Ten seconds take 0.011 of the energy at 0.125
// radians, 0.042 at 0.25, 0.11 at 0.42 and 0.28 at 0.83; beyond a radian it is still led round, but far outside.
TEST_CASE("a bead is led round a ball at up to a radian a sub-step") {
  for (const double turn : {0.01, 0.04, 0.1, 0.25, 0.5, 1.0, 1.5}) {
    World world;
    prepare_slides(world, kDown);
    BodyDescription bead = cube("bead", 0.05, {1.0, 0, 0});
    bead.velocity = {0, 0, turn / world.parameters.simulation.time_step()};
    world.add_body(bead);
    BodyDescription ball = dynamic_body("ball", Sphere{1.0}, Vec3::Zero());
    ball.kind = BodyKind::fixed;
    world.add_body(ball);
    world.add_attachment(slide(AttachmentKind::surface, "bead", "ball", bead.position));
    world.start();
    const Seen s = watch(world, 10.0, 1.0, energy_of(world) + world.bodies()[0].mass * kGravity);
    CAPTURE(turn, s.off, s.energy);
    CHECK(s.off < std::max(0.6 * turn * turn, 3e-4));
    CHECK(s.energy < std::max(0.4 * turn, 5e-3));
  }
}

// A body on an arm of a hundred of its sizes has next to no mass where it is held: as it swings through below its point,
// that comes to hundreds of metres a second. What can't be followed may be lost, but no energy comes of it.
TEST_CASE(
    "a point that slides far from its body's centre stays on its way up to six sizes off, and wins no energy beyond") {
  for (const char* response : {"constraint_anticipation", "sequential_impulse"})
    for (const double arm : {0.0, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4}) {
      World world;
      prepare_slides(world, kDown);
      use(world, response);
      world.add_body(dynamic_body("box", Box(Vec3(0.05, 0.1, 0.15)), Vec3::Zero()));
      const Vec3 at = arm * Vec3(1.0, 1.0, 0.5).normalized();
      world.add_attachment(slide(AttachmentKind::line, "box", "", at, Vec3(1, 0, 0.3)));
      world.start();
      const double scale = world.bodies()[0].mass * kGravity * std::max(arm, 0.1), start = energy_of(world);
      const Seen s = watch(world, 10.0, 1.0, scale);
      CAPTURE(response, arm, s.off, s.energy);
      if (arm <= 1.0) CHECK(s.off < 2e-3);
      if (arm == 10.0) CHECK(s.off < 1.0);
      CHECK(energy_of(world) < start + 2.0 * scale);
    }
}

TEST_CASE("what starts off the surface is led there at the speed of recovery, and stays") {
  for (const double from : {1e-4, 1e-2, 0.1, 1.0, -0.1, -0.5, -0.999}) {
    World world;
    prepare_slides(world, Vec3::Zero());
    const Vec3 out = (1.0 + from) * Vec3(0.36, 0.48, 0.8);
    world.add_body(cube("bead", 0.05, out));
    BodyDescription ball = dynamic_body("ball", surface(icosphere(3)), Vec3::Zero());
    ball.kind = BodyKind::fixed;
    world.add_body(ball);
    world.add_attachment(slide(AttachmentKind::surface, "bead", "ball", out));
    world.start();
    const double speed = 0.65 * std::sqrt(9.80665 * world.bodies()[0].size), far = link_of(world).error();
    double fastest = 0.0;
    for (int i = 0; i < static_cast<int>(60.0 * far / speed) + 4; ++i) {
      world.step();
      fastest = std::max(fastest, world.bodies()[0].twist().linear.norm());
    }
    CAPTURE(from, far, fastest, speed, link_of(world).error());
    CHECK(fastest < 1.001 * speed);
    CHECK(link_of(world).error() < 1e-12);
    CHECK(world.bodies()[0].twist().linear.norm() < 0.01 * speed);  // along it, from the corner where it came in
  }
}
