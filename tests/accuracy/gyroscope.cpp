// A disc on an axle whose end is held in a point, level, with the turn that its weight asks for: it goes round steadily.
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a gyroscope stays on its pin and goes round as its weight has it, whatever its spin turns in a sub-step") {
  constexpr double kRadius = 0.1, kHalf = 0.01;  // metres
  struct Case {
    double arm, spin;  // metres, rad/s
  };
  for (const Case& c : {Case{0.1, 100.0}, Case{0.1, 300.0}, Case{0.1, 500.0}, Case{0.03, 300.0}, Case{0.3, 1000.0}}) {
    CAPTURE(c.arm, c.spin);
    World world;
    world.parameters.simulation.sleeping = false;
    // of a mass of 1 kg; steady precession of a level axis: m g l = I_spin ω_spin Ω
    const double inertia = 0.5 * kRadius * kRadius, round = kGravity * c.arm / (inertia * c.spin);
    BodyDescription disc = dynamic_body("disc", cylinder(kRadius, 2.0 * kHalf), {c.arm, 0.0, 0.0});
    disc.mass = 1.0;
    disc.rotation = {0.0, 0.0, -90.0};
    disc.angular_velocity = {c.spin, round, 0.0};
    disc.velocity = {0.0, 0.0, -round * c.arm};
    world.add_body(disc);
    AttachmentDescription pin;
    pin.name = "pin", pin.body_a = "disc";
    world.add_attachment(pin);
    world.start();
    const double kinetic = world.record().stats.kinetic;
    double error = 0.0, angle = 0.0, before = 0.0;
    for (int i = 0; i < 360; ++i) {
      world.step();
      error = std::max(error, world.record().stats.attachment_error);
      const Vec3 x = rigid(world, 0).pose.position;
      const double at = std::atan2(-x.z(), x.x());
      angle += std::remainder(at - before, 2.0 * M_PI), before = at;
    }
    CHECK(error < 0.02 * c.arm);
    CHECK(world.record().stats.kinetic == Approx(kinetic).epsilon(0.01));
    CHECK(angle == Approx(6.0 * round).epsilon(0.02));
    CHECK(std::abs(rigid(world, 0).pose.position.y()) < 0.05 * c.arm);
    CHECK(world.record().stats.unconverged == 0);
  }
}
