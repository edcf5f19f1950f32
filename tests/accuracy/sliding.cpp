// What slides on lines and planes, against formulas of point mechanics.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/slides.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Turns about y at `rate`, rad/s, from long before the start: key frames rest at their ends.
BodyDescription turning_arm(double rate) {
  BodyDescription arm = dynamic_body("arm", Box(Vec3(1.0, 0.01, 0.01)), Vec3::Zero());
  arm.kind = BodyKind::scripted;
  for (const double t : {-20.0, -10.0, 10.0, 20.0})
    arm.motion.push_back({t, Vec3::Zero(), Vec3(0, rate * t * 180.0 / M_PI, 0)});
  return arm;
}

/// Distance from the axis of a bead on an arm that turns for a second; and how far off the arm it came.
std::pair<double, double> bead_on_arm(double rate, double r0, int substeps) {
  World world;
  prepare_slides(world, Vec3::Zero(), substeps);
  BodyDescription bead = cube("bead", 0.05, {r0, 0, 0});
  bead.velocity = {0, 0, -rate * r0};
  world.add_body(bead);
  world.add_body(turning_arm(rate));
  world.add_attachment(slide(AttachmentKind::line, "bead", "arm", bead.position, Vec3::UnitX()));
  world.start();
  const double off = run_slides(world, 1.0);
  return {world.bodies()[0].pose.position.norm(), off};
}

}  // namespace

TEST_CASE("a bead on an inclined line gains g sin a, for every response") {
  for (const auto& response : responses())
    for (const double degrees : {0.0, 5.0, 30.0, 60.0, 90.0}) {
      const double a = degrees * M_PI / 180.0;
      const Vec3 direction(std::cos(a), -std::sin(a), 0.0);
      World world;
      prepare_slides(world, kDown);
      use(world, response.name);
      world.add_body(cube("bead", 0.1, {0.3, 2.0, -0.1}));
      world.add_attachment(slide(AttachmentKind::line, "bead", "", {0.3, 2.0, -0.1}, 7.0 * direction));
      world.start();
      const double off = run_slides(world, 1.0), h = world.parameters.simulation.time_step();
      const Body& bead = world.bodies()[0];
      const Vec3 way = bead.pose.position - Vec3(0.3, 2.0, -0.1), force = link_force(world);
      CAPTURE(response.name, degrees, off, way, force, bead.mass);
      const double slack = regularised(response.name) ? 1e-3 : 1e-8;
      CHECK(off < 1e-12 + (regularised(response.name) ? kGravity * h * h : 0.0));
      CHECK(bead.twist().linear.dot(direction) == Approx(kGravity * std::sin(a)).margin(1e-9));
      CHECK(way.dot(direction) ==
            Approx(0.5 * kGravity * std::sin(a) * (1.0 + moving_step(world, response.name))).margin(1e-9));
      CHECK(std::abs(force.dot(direction)) < 1e-9 * bead.mass * kGravity);
      CHECK((force + bead.mass * (kDown - kDown.dot(direction) * direction)).norm() < slack * bead.mass * kGravity);
    }
}

TEST_CASE("a bead on a turning arm flies out as r0 cosh(w t), to second order in the sub-step") {
  for (const double rate : {0.5, 2.0, 5.0}) {
    const double r0 = 0.1, exact = r0 * std::cosh(rate);
    double before = 0.0;
    for (const int substeps : {4, 16, 64}) {
      const auto [r, off] = bead_on_arm(rate, r0, substeps);
      const double error = std::abs(r - exact) / exact;
      CAPTURE(rate, substeps, r, exact, error, off);
      CHECK(error < 0.2 * std::pow(rate / substeps, 2) / 60.0);
      CHECK(off < 0.4 * std::pow(rate / substeps, 2) / 60.0);
      if (before > 0.0) CHECK(error == Approx(before / 16.0).epsilon(0.1));
      before = error;
    }
  }
}

TEST_CASE("a point in a plane moves as an oblique force within the plane makes it") {
  const Vec3 normal = Vec3(1.0, 2.0, -1.0).normalized(), force(3.0, -9.81, 2.0);
  for (const auto& response : responses()) {
    World world;
    prepare_slides(world, force);
    use(world, response.name);
    BodyDescription disc = cube("disc", 0.1, {0.2, 0.1, 0.0});
    disc.velocity = normal.cross(Vec3::UnitX());
    world.add_body(disc);
    world.add_attachment(slide(AttachmentKind::plane, "disc", "", disc.position, normal));
    world.start();
    const double off = run_slides(world, 2.0), h = world.parameters.simulation.time_step();
    const Vec3 within = force - normal.dot(force) * normal;
    const Vec3 way = world.bodies()[0].pose.position - disc.position,
               wanted = 2.0 * disc.velocity + 0.5 * within * 2.0 * (2.0 + moving_step(world, response.name));
    CAPTURE(response.name, off, way, wanted, link_force(world));
    const double slack = regularised(response.name) ? 1e-3 : 1e-9;
    CHECK(off < 1e-12 + (regularised(response.name) ? kGravity * h * h : 0.0));
    CHECK((way - wanted).norm() < slack);
    CHECK(link_force(world).cross(normal).norm() < 1e-9);
    CHECK((link_force(world) + world.bodies()[0].mass * normal.dot(force) * normal).norm() <
          slack * world.bodies()[0].mass * kGravity);
  }
}

TEST_CASE("a rod whose end slides on a plane falls about its middle: no push along the plane, energy kept") {
  // stands askew, let go: m ẏ²/2 + I w²/2 = m g (y0 - y), y = l cos(a), ẏ = -l sin(a) w  [LandauLifshitz76]
  const double half = 0.5, a0 = 0.3;
  World world;
  prepare_slides(world, kDown, 64);
  BodyDescription rod = dynamic_body("rod", Box(Vec3(0.01, half, 0.01)), Vec3(0, half * std::cos(a0), 0));
  rod.rotation = Vec3(0, 0, -a0 * 180.0 / M_PI);
  world.add_body(rod);
  world.add_attachment(slide(AttachmentKind::plane, "rod", "", Vec3(-half * std::sin(a0), 0, 0), Vec3::UnitY()));
  world.start();
  const double before = energy_of(world), size = world.bodies()[0].mass * kGravity * half;
  double worst = 0.0, off = 0.0, aside = 0.0;
  const double inertia_by_mass = (4.0 * half * half + 4e-4) / 12.0;
  for (int i = 0; i < 30; ++i) {
    world.step();
    const Body& body = world.bodies()[0];
    const Vec3 axis = body.pose.rotation.col(1);
    const double sine = axis.head<2>().norm() > 0.0 ? axis.x() : 0.0, fall = half * (std::cos(a0) - axis.y());
    const double w = std::sqrt(2.0 * kGravity * fall / (inertia_by_mass + half * half * sine * sine));
    worst = std::max(worst, std::abs(body.twist().angular.norm() - w) / (1.0 + w));
    aside = std::max(aside, std::hypot(body.pose.position.x(), body.pose.position.z()));
    off = std::max(off, world.record().stats.attachment_error);
  }
  CHECK(worst < 2e-3);
  CHECK(aside < 1e-12);
  CHECK(off < 1e-6);
  CHECK(std::abs(energy_of(world) - before) < 2e-3 * size);
}

TEST_CASE("the momentum along the line is the force's, for a soft body that hangs on it by a point") {
  const Vec3 direction = Vec3(2.0, -1.0, 0.5).normalized();
  for (const auto& integrator : integrators()) {
    World world;
    prepare_slides(world, kDown, integrator.name == "symplectic_euler" ? 64 : 4);
    world.parameters.simulation.integrator = integrator.name;
    world.parameters.simulation.linear_solver = "simplicial_llt";
    world.parameters.lcp.tolerance = 1e-13;
    world.add_body(soft_cube("soft", 0.2, 2, {0, 0, 0}, {2e4, 0.3, 1000.0, 2e-3, "corotational"}));
    world.add_attachment(slide(AttachmentKind::line, "soft", "", {0.1, 0.2, 0.1}, direction));
    world.start();
    double worst = 0.0;
    for (int i = 1; i <= 120; ++i) {
      world.step();
      const double wanted = world.bodies()[0].mass * kDown.dot(direction) * world.time();
      worst = std::max(worst, std::abs(world.record().stats.momentum.dot(direction) - wanted) / wanted);
    }
    CAPTURE(integrator.name, worst, world.record().stats.attachment_error);
    CHECK(worst < 1e-12);
    CHECK(world.record().stats.attachment_error < 1e-12);
  }
}

TEST_CASE("the rod of a trammel goes round evenly, its ends on two crossed lines") {
  // m l²/8 w² + m l²/24 w²: the same in every position, so w is
  const double half = 0.35, rate = 2.0, a0 = 0.4;
  for (const char* response : {"constraint_anticipation", "sequential_impulse"}) {
    World world;
    prepare_slides(world, kDown, 8);
    use(world, response);
    const Vec3 middle(half * std::cos(a0), 0.0, half * std::sin(a0));
    BodyDescription rod = dynamic_body("rod", Box(Vec3(half, 0.005, 0.005)), middle);
    rod.rotation = Vec3(0, a0 * 180.0 / M_PI, 0);
    rod.velocity = rate * Vec3(-middle.z(), 0.0, middle.x());
    rod.angular_velocity = {0, rate, 0};
    world.add_body(rod);
    world.add_attachment(slide(AttachmentKind::line, "rod", "", Vec3(2.0 * middle.x(), 0, 0), Vec3::UnitX()));
    world.add_attachment(slide(AttachmentKind::line, "rod", "", Vec3(0, 0, 2.0 * middle.z()), Vec3::UnitZ()));
    world.start();
    double worst = 0.0, round = 0.0, off = 0.0;
    for (int i = 0; i < 600; ++i) {
      world.step();
      const Body& body = world.bodies()[0];
      worst = std::max(worst, std::abs(body.twist().angular.y() / rate - 1.0));
      round = std::max(round, std::abs(body.pose.position.norm() / half - 1.0));
      off = std::max(off, world.record().stats.attachment_error);
    }
    CAPTURE(response, worst, round, off);
    CHECK(worst < 1e-4);
    CHECK(round < 1e-4);
    CHECK(off < 5e-5);
  }
}
