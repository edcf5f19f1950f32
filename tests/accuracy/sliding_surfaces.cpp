// What slides on the surfaces of bodies: the spherical pendulum, meshes, soft bodies.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/mechanics/slides.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// On a ball of a metre, `angle` from its lowest point.
Vec3 on_ball(double angle) { return {std::sin(angle), -std::cos(angle), 0.0}; }

/// A small cube whose middle slides on a ball of a metre, or on what stands for one.
void hang_on_ball(World& world, const SharedShape& ball, double angle, const Vec3& velocity, int substeps) {
  prepare_slides(world, kDown, substeps);
  BodyDescription bob = cube("bob", 0.05, on_ball(angle));
  bob.velocity = velocity;
  world.add_body(bob);
  world.add_body(fixed_body("ball", ball));
  world.add_attachment(slide(AttachmentKind::surface, "bob", "ball", bob.position));
  world.start();
}

/// Seconds between the first and the third passage through x = 0.
double period_of(World& world) {
  std::vector<double> passages;
  double x = world.bodies()[0].pose.position.x(), t = world.time();
  while (passages.size() < 3 && world.time() < 20.0) {
    world.step();
    const double now = world.bodies()[0].pose.position.x();
    if (x * now <= 0.0 && x != 0.0) passages.push_back(t + (world.time() - t) * x / (x - now));
    x = now, t = world.time();
  }
  return passages.size() < 3 ? INFINITY : passages[2] - passages[0];
}

double mean(double a, double b) {
  for (int i = 0; i < 40; ++i) {
    const double g = std::sqrt(a * b);
    a = 0.5 * (a + b), b = g;
  }
  return a;
}

}  // namespace

TEST_CASE("a mass on a ball's surface swings with the pendulum's period, at any width") {
  for (const double degrees : {1.0, 30.0, 90.0, 150.0}) {
    const double a = degrees * M_PI / 180.0;
    World world;
    hang_on_ball(world, Sphere{1.0}, a, Vec3::Zero(), 16);
    const double period = period_of(world), exact = 2.0 * M_PI / std::sqrt(kGravity) / mean(1.0, std::cos(0.5 * a));
    CAPTURE(degrees, period, exact);
    CHECK(period == Approx(exact).epsilon(2e-5));
  }
}

TEST_CASE("the spherical pendulum keeps its energy and its spin about the vertical for ten seconds") {
  for (const int substeps : {4, 16}) {
    World world;
    hang_on_ball(world, Sphere{1.0}, 1.0, Vec3(0, 0, 1.5), substeps);
    const double before = energy_of(world), size = world.bodies()[0].mass * kGravity,
                 spin = world.record().stats.angular_momentum.y();
    double worst = 0.0, off = 0.0, spun = 0.0;
    for (int i = 0; i < 600; ++i) {
      world.step();
      worst = std::max(worst, std::abs(energy_of(world) - before) / size);
      spun = std::max(spun, std::abs(world.record().stats.angular_momentum.y() / spin - 1.0));
      off = std::max(off, world.record().stats.attachment_error);
    }
    CHECK(worst < 0.02 / substeps);
    CHECK(spun < 1e-12);
    CHECK(off < 3e-3 / (substeps * substeps));
  }
}

TEST_CASE("the conical pendulum goes round at its height") {
  const double a = 0.8, speed = std::sin(a) * std::sqrt(kGravity / std::cos(a));
  World world;
  hang_on_ball(world, Sphere{1.0}, a, Vec3(0, 0, speed), 16);
  double worst = 0.0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    worst = std::max(worst, std::abs(world.bodies()[0].pose.position.y() + std::cos(a)));
  }
  CHECK(worst < 1e-3);
}

// Each edge is a corner, where what goes on along the next face is the velocity's share along it. Measured: 0.34, 0.24,
// 0.19 and 0.10 of the energy in the first swing and a half.
TEST_CASE("on a mesh of a ball the energy lost falls as the triangles do, and the point stays on them") {
  double before = 1.0;
  for (const int level : {2, 3, 4, 5}) {
    World world;
    hang_on_ball(world, surface(icosphere(level)), 1.0, Vec3::Zero(), 16);
    const double start = energy_of(world), size = world.bodies()[0].mass * kGravity * (1.0 - std::cos(1.0));
    const double period = period_of(world), exact = 2.0 * M_PI / std::sqrt(kGravity) / mean(1.0, std::cos(0.5));
    const double lost = (start - energy_of(world)) / size;
    CAPTURE(level, period, exact, lost, world.record().stats.attachment_error);
    CHECK(world.record().stats.attachment_error < 1e-9);
    CHECK(lost > 0.0);
    CHECK(lost < 0.8 * before + 0.1);
    CHECK(period == Approx(exact).epsilon(0.03));
    before = lost;
  }
}

TEST_CASE("a flat face is flat whatever its triangles: what slides over it keeps its speed") {
  for (const bool off_centre : {false, true}) {
    World world;
    prepare_slides(world, kDown);
    BodyDescription bead = cube("bead", 0.05, {-0.8, off_centre ? 0.6 : 0.5, -0.31});
    bead.velocity = {1.7, 0, 0.6};
    world.add_body(bead);
    world.add_body(fixed_body("table", surface(box({1.0, 0.5, 1.0}, {13, 3, 11}))));
    world.add_attachment(slide(AttachmentKind::surface, "bead", "table", {-0.8, 0.5, -0.31}));
    world.start();
    const double off = run_slides(world, 0.8);
    const Vec3 velocity = world.bodies()[0].twist().linear;
    CAPTURE(off_centre, velocity, off);
    CHECK((velocity - bead.velocity).norm() < 1e-9);
    CHECK(off < 1e-12);
    CHECK(link_force(world).cross(Vec3::UnitY()).norm() < 1e-9);
  }
}

TEST_CASE("what slides on a body that is free to move leaves momentum and spin to both as they were") {
  const SoftOptions soft{1e5, 0.3, 1000.0, 2e-3, "corotational"};
  const Vec3 at(0.06, 0.08, 0.0);  // on the ball; in all others
  for (const std::string carrier : {"ball", "mesh", "hull", "compound", "soft"})
    for (const AttachmentKind kind : {AttachmentKind::line, AttachmentKind::plane, AttachmentKind::surface}) {
      World world;
      prepare_slides(world, Vec3::Zero());
      world.parameters.lcp.tolerance = 1e-13;
      world.parameters.simulation.linear_solver = "simplicial_llt";
      BodyDescription bead = cube("bead", 0.05, at);
      bead.velocity = {0.4, -0.3, -0.2};
      world.add_body(bead);
      BodyDescription d = dynamic_body("carrier", Sphere{0.1}, Vec3::Zero());
      if (carrier == "mesh") d.shape = surface(icosphere(2, 0.1));
      if (carrier == "hull") d.shape = made_hull(box_corners(Vec3(0.1, 0.1, 0.1)));
      if (carrier == "compound")
        d.shape =
            made_compound({{Sphere{0.1}, {}}, {Box(Vec3(0.05, 0.02, 0.02)), {Mat3::Identity(), -Vec3::UnitX() / 10}}});
      if (carrier == "soft") d = soft_cube("carrier", 0.2, 2, Vec3(-0.1, -0.1, -0.1), soft);
      world.add_body(d);
      world.add_attachment(slide(kind, "bead", "carrier", at, kind == AttachmentKind::line ? bead.velocity : at));
      world.start();
      const Vec3 momentum = world.record().stats.momentum, spin = world.record().stats.angular_momentum;
      const double energy = energy_of(world);
      run_slides(world, 1.0);
      const FrameStats& s = world.record().stats;
      CAPTURE(carrier, static_cast<int>(kind), s.attachment_error, energy_of(world) / energy);
      CHECK((s.momentum - momentum).norm() < 1e-12 * momentum.norm());
      // nodes go straight ahead in a sub-step while forces turn with them: all of a soft body's spin is first order
      CHECK((s.angular_momentum - spin).norm() < (carrier == "soft" ? 1e-3 : 1e-12) * 0.1 * momentum.norm());
      CHECK(s.attachment_error < 5e-4);
      // round corners, and in a soft body's damping, some is lost
      CHECK(energy_of(world) < 1.001 * energy);
    }
}

TEST_CASE("on a face of a box that turns by a script a bead flies out as x0 cosh(w t), exact box and mesh") {
  const double rate = 2.0, x0 = 0.1;
  for (const bool mesh : {false, true}) {
    World world;
    prepare_slides(world, Vec3::Zero());
    const Vec3 at(x0, 0.05, 0.2);
    BodyDescription bead = cube("bead", 0.02, at);
    bead.velocity = rate * Vec3(0.2, 0.0, -x0);  // of the box's point there
    world.add_body(bead);
    const Vec3 half(2.0, 0.1, 0.2);
    BodyDescription turning =
        dynamic_body("box", mesh ? surface(box(half, {17, 2, 3})) : SharedShape(Box(half)), Vec3::Zero());
    turning.kind = BodyKind::scripted;
    for (const double t : {-20.0, -10.0, 10.0, 20.0})
      turning.motion.push_back({t, Vec3::Zero(), Vec3(0, rate * t * 180.0 / M_PI, 0)});
    world.add_body(turning);
    world.add_attachment(slide(AttachmentKind::surface, "bead", "box", at));
    world.start();
    const double off = run_slides(world, 1.0);
    const Vec3 now = world.bodies()[1].pose.apply_inverse(world.bodies()[0].pose.position);
    // ẍ = w² x along the face; across it the face holds
    const double exact = x0 * std::cosh(rate);
    CAPTURE(mesh, now, exact, off);
    CHECK(now.x() == Approx(exact).epsilon(1e-3));
    CHECK(std::abs(now.z() - 0.2) < 1e-3);
    CHECK(now.y() == Approx(0.05).epsilon(1e-9));
    CHECK(off < 1e-3);
  }
}
