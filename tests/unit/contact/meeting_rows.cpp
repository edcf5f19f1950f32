// Rows of what meets in flight, made by hand.
#include <catch2/catch.hpp>

#include "engine/contact/assemble.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("what meets as its sub-step ends has a row of numbers, and rebounds with its share") {
  constexpr double kTimeStep = 0.01, kSpeed = 2.0, kRestitution = 0.5;
  for (const double share : {0.25, 1.0 - 1e-9, 1.0}) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.contact.restitution = kRestitution;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    const double gap = share * kTimeStep * kSpeed;
    BodyDescription ball = dynamic_body("ball", Sphere{0.1}, {0.0, 0.1 + gap, 0.0});
    ball.velocity = {0.0, -kSpeed, 0.0};
    world.add_body(ball);
    world.start();
    Collision c;
    c.body_a = BodyIndex(0), c.body_b = BodyIndex(1);
    c.normal = -Vec3::UnitY();
    c.point_b = {0.0, gap, 0.0};
    c.gap = gap;
    Meeting meeting;
    meeting.time = share * kTimeStep;
    c.meeting = std::make_shared<const Meeting>(meeting);
    CollisionGroup group;
    group.bodies = {BodyIndex(1)};
    group.contacts = {ContactIndex(0)};
    const AssembledGroup made = assemble({.bodies = world.bodies(),
                                          .contacts = {{&c, 1}, {}},
                                          .start = {},
                                          .settings = world.parameters.contact,
                                          .time_step = kTimeStep,
                                          .gravity = 9.81},
                                         group);
    CAPTURE(share);
    REQUIRE(made.system.contacts.size() == 1);
    const ContactRows& row = made.system.contacts.front();
    CHECK(std::isfinite(row.bound));
    CHECK(row.bound == Approx(kRestitution * kSpeed).epsilon(1e-9));
    CHECK(row.velocity_before == Approx(-kSpeed).epsilon(1e-12));
  }
}
