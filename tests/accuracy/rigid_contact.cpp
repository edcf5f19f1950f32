// Contact against formulas: rest, stacks, inclines, bounces, momentum.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <iostream>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// What matters of a resting scene at its end, for messages.
void add_stack(World& world, int boxes, double size) {
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  for (int i = 0; i < boxes; ++i) world.add_body(cube("box" + std::to_string(i), size, Vec3(0, size * (i + 0.5), 0)));
}

}  // namespace

TEST_CASE("a box rests on a floor for 10 s") {
  World world;
  world.parameters.simulation.sleeping = false;
  add_stack(world, 1, 1.0);
  world.start();
  double deepest = 0.0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    deepest = std::max(deepest, world.record().stats.max_penetration);
  }
  CHECK(world.record().stats.contacts == 4);
  CHECK(deepest < 1e-6);
  CHECK(fastest(world) < 1e-6);
  CHECK(std::abs(world.bodies()[1].pose.position.y() - 0.5) < 1e-6);
  // total impulse of a sub-step carries the weight
  double sum = 0.0;
  for (const ContactRecord& c : world.record().contacts)
    sum += c.lambda.x() * c.normal.y() * (c.body_a == 1 ? 1.0 : -1.0);
  const double weight = world.bodies()[1].mass * 9.81 * world.parameters.simulation.time_step();
  CHECK(std::abs(sum) == Approx(weight).epsilon(1e-6));
}

TEST_CASE("a stack of ten boxes stands for 10 s") {
  World world;
  world.parameters.simulation.sleeping = false;
  add_stack(world, 10, 1.0);
  world.start();
  run(world, 600);
  const Body& top = world.bodies().back();
  const Vec3 drift = top.pose.position - Vec3(0, 9.5, 0);
  CAPTURE(drift.transpose(), fastest(world), world.record().stats.residual, world.record().stats.max_penetration);
  WARN("top drift " << drift.norm() << " m, tilt " << tilt_degrees(top) << " deg, residual "
                    << world.record().stats.residual << " m/s");
  CHECK(drift.norm() < 1e-3);
  CHECK(tilt_degrees(top) < 0.1);
  CHECK(world.record().stats.max_penetration < 1e-5);
}

TEST_CASE("intersection contacts chatter by about g h², proximity contacts do not") {
  double range[2];
  for (int proximity = 0; proximity < 2; ++proximity) {
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.contact.points = proximity ? ContactPoints::proximity : ContactPoints::intersection;
    world.parameters.simulation.substeps = 1;
    add_stack(world, 1, 1.0);
    world.bodies()[1].pose.position.y() += 1e-4;  // it has to find its own rest
    world.start();
    run(world, 120);
    double low = 1e9, high = -1e9;
    for (int i = 0; i < 120; ++i) {
      world.step();
      low = std::min(low, world.bodies()[1].pose.position.y());
      high = std::max(high, world.bodies()[1].pose.position.y());
    }
    range[proximity] = high - low;
  }
  const double g_h2 = 9.81 / 3600.0;
  WARN("height range at rest: intersection " << range[0] << " m (g h² = " << g_h2 << "), proximity " << range[1]
                                             << " m");
  CHECK(range[0] < 2.0 * g_h2);
  CHECK(range[1] < 1e-9);
}

TEST_CASE("sleeping moves no resting pose") {
  std::vector<Vec3> end[2];
  int asleep = 0;
  for (int sleeping = 0; sleeping < 2; ++sleeping) {
    World world;
    world.parameters.simulation.sleeping = sleeping == 1;
    add_stack(world, 3, 0.5);
    world.add_body(dynamic_body("ball", Sphere{0.3}, Vec3(2, 0.3, 0)));
    world.start();
    run(world, 300);
    for (const Body& b : world.bodies()) end[sleeping].push_back(b.pose.position);
    asleep = world.record().stats.asleep;
  }
  CHECK(asleep == 4);
  for (std::size_t i = 0; i < end[0].size(); ++i) CHECK((end[0][i] - end[1][i]).norm() < 1e-9);
}

TEST_CASE("a sleeper wakes when it is hit, when its support moves and when a parameter changes") {
  World world;
  add_stack(world, 2, 0.5);
  BodyDescription lift = dynamic_body("lift", Box{Vec3(0.5, 0.1, 0.5)}, Vec3::Zero());
  lift.kind = BodyKind::scripted;
  lift.motion = {
      {0.0, Vec3(3, 0.1, 0), Vec3::Zero()}, {3.0, Vec3(3, 0.1, 0), Vec3::Zero()}, {4.0, Vec3(3, 1.1, 0), Vec3::Zero()}};
  world.add_body(lift);
  world.add_body(cube("rider", 0.4, Vec3(3, 0.4, 0)));
  BodyDescription shot = dynamic_body("shot", Sphere{0.1}, Vec3(-40.0, 0.6, 0));
  shot.velocity = Vec3(20, 9.81, 0);
  world.add_body(shot);
  world.start();
  run(world, 110);
  CHECK(world.bodies()[1].asleep);
  CHECK(world.bodies()[4].asleep);
  run(world, 25);  // the shot arrives after 2 s
  CHECK_FALSE(world.bodies()[1].asleep);
  run(world, 135);  // 4.5 s: the lift is up
  CHECK(world.bodies()[4].pose.position.y() == Approx(1.4).margin(1e-4));
  run(world, 120);
  REQUIRE(world.bodies()[4].asleep);
  world.parameters_changed();
  CHECK(world.bodies()[4].asleep);
  world.parameters.simulation.gravity = Vec3(0, 0, 5);
  world.parameters_changed();
  CHECK_FALSE(world.bodies()[4].asleep);
}

TEST_CASE("a block on an incline sticks below the friction angle and slides above it") {
  const double angle = 25.0 * M_PI / 180.0, g = 9.81;
  const Vec3 normal(-std::sin(angle), std::cos(angle), 0.0), down(-std::cos(angle), -std::sin(angle), 0.0);
  for (double mu : {std::tan(angle) * 1.02, std::tan(angle) * 0.98, std::tan(angle) * 0.5, 0.0}) {
    CAPTURE(mu);
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.contact.friction = mu;
    world.add_body(fixed_plane("slope", normal, 0.0));
    BodyDescription block = dynamic_body("block", Box{Vec3(0.5, 0.25, 0.5)}, Vec3::Zero());
    block.position = 0.25 * normal;
    block.rotation = Vec3(0, 0, 25.0);
    world.add_body(block);
    world.start();
    const Vec3 start = world.bodies()[1].pose.position;
    const int frames = 300;
    run(world, frames);
    const Vec3 moved = world.bodies()[1].pose.position - start;
    if (mu > std::tan(angle)) {
      CHECK(moved.norm() < 1e-6);
    } else {
      const double a = g * (std::sin(angle) - mu * std::cos(angle)), t = frames / 60.0,
                   h = world.parameters.simulation.time_step();
      // discrete sum of the constant acceleration
      CHECK(moved.dot(down) == Approx(0.5 * a * t * (t + h)).epsilon(1e-3));
      CHECK(rigid(world, 1).velocity.dot(down) == Approx(a * t).epsilon(1e-3));
      CHECK(std::abs(moved.dot(normal)) < 1e-6);
    }
  }
}

TEST_CASE("a sliding block stops after v²/2µg, whatever the direction") {
  const double v = 3.0, mu = 0.5, g = 9.81, exact = v * v / (2 * mu * g);
  double shortest = 1e9, longest = 0.0;
  for (int degrees = 0; degrees <= 45; degrees += 15) {
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.contact.friction = mu;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    const double a = degrees * M_PI / 180.0;
    const Vec3 direction(std::cos(a), 0, std::sin(a));
    BodyDescription block = dynamic_body("block", Box{Vec3(0.5, 0.05, 0.5)}, Vec3(0, 0.05, 0));
    block.velocity = v * direction;
    world.add_body(block);
    world.start();
    run(world, 60);
    const Vec3 moved = world.bodies()[1].pose.position - Vec3(0, 0.05, 0);
    CHECK(rigid(world, 1).velocity.norm() < 1e-9);
    CHECK((moved - moved.dot(direction) * direction).norm() < 1e-3 * exact);  // straight
    // backward Euler brakes a step early: d_h = d - v h/2 + O(h²)
    CHECK(moved.dot(direction) == Approx(exact - 0.5 * v * world.parameters.simulation.time_step()).epsilon(5e-4));
    shortest = std::min(shortest, moved.norm());
    longest = std::max(longest, moved.norm());
  }
  CHECK(longest / shortest - 1.0 < 1e-2);
}

TEST_CASE("a ball bounces as its restitution says") {
  for (double e : {0.0, 0.5, 0.8, 1.0}) {
    CAPTURE(e);
    World world;
    world.parameters.simulation.frame_time = 1e-3;
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.restitution = e;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    world.add_body(dynamic_body("ball", Sphere{0.5}, Vec3(0, 2, 0)));
    world.start();
    double apex = 0.0;
    bool hit = false;
    for (int i = 0; i < 1600; ++i) {
      world.step();
      hit = hit || world.record().stats.contacts > 0;
      if (hit) apex = std::max(apex, world.bodies()[1].pose.position.y());
      if (hit && e > 0.0 && rigid(world, 1).velocity.y() < -0.5) break;
    }
    CHECK(apex == Approx(0.5 + 1.5 * e * e).margin(0.01));
  }
}

TEST_CASE("collisions between free bodies keep linear and angular momentum") {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    CAPTURE(trial);
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.contact.friction = trial % 3 == 0 ? 0.0 : 0.5;
    world.parameters.contact.restitution = trial % 2 ? 0.7 : 0.0;
    const SharedShape shapes[] = {Sphere{0.3}, Box{Vec3(0.2, 0.3, 0.4)}, Capsule{0.2, 0.3}};
    for (int i = 0; i < 6; ++i) {
      const Vec3 place = 1.2 * random.direction() * (1.0 + 0.8 * i);
      BodyDescription d = dynamic_body("body" + std::to_string(i), shapes[i % 3], place);
      d.velocity = -1.5 * place / (1.0 + 0.8 * i) + 0.3 * random.vector();
      d.angular_velocity = 3.0 * random.vector();
      d.rotation = 180.0 * random.vector();
      world.add_body(d);
    }
    world.start();
    double p_scale = 0.0, l_scale = 0.0;
    for (const Body& b : world.bodies()) {
      p_scale += b.mass * b.twist().linear.norm();
      const auto* own = b.as<RigidBody>();
      l_scale += (b.pose.position.cross(b.mass * b.twist().linear) + own->angular_momentum).norm();
    }
    const Vec3 p0 = world.record().stats.momentum, l0 = world.record().stats.angular_momentum;
    std::int64_t impacts = 0;
    for (int i = 0; i < 180; ++i) {
      world.step();
      impacts += world.record().stats.lcp_iterations;
    }
    CHECK(impacts > 0);
    CHECK((world.record().stats.momentum - p0).norm() < 1e-10 * p_scale);
    CHECK((world.record().stats.angular_momentum - l0).norm() < 1e-10 * l_scale);
  }
}

TEST_CASE("a rolling ball: from sliding to rolling, and down an incline") {
  World world;
  world.parameters.simulation.sleeping = false;
  world.parameters.contact.friction = 0.2;
  world.parameters.simulation.frame_time = 1e-3;
  world.parameters.simulation.substeps = 1;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  BodyDescription ball = dynamic_body("ball", Sphere{0.25}, Vec3(0, 0.25, 0));
  ball.velocity = Vec3(7, 0, 0);
  world.add_body(ball);
  world.start();
  run(world, 1500);
  CHECK(rigid(world, 1).velocity.x() == Approx(5.0).epsilon(1e-3));
  const double t = 2.0 * 7.0 / (7.0 * 0.2 * 9.81), x = 12.0 * 49.0 / (49.0 * 0.2 * 9.81);
  CHECK(world.bodies()[1].pose.position.x() == Approx(x + 5.0 * (1.5 - t)).epsilon(2e-3));
}

TEST_CASE("a stack of mesh boxes stands on a mesh floor") {
  World world;
  world.parameters.simulation.sleeping = false;
  BodyDescription floor = dynamic_body("floor", make_box_mesh(Vec3(2, 0.5, 2)), Vec3(0, -0.5, 0));
  floor.kind = BodyKind::fixed;
  world.add_body(floor);
  for (int i = 0; i < 5; ++i)
    world.add_body(
        dynamic_body("box" + std::to_string(i), make_box_mesh(Vec3::Constant(0.5)), Vec3(0.01 * i, i + 0.5, 0)));
  world.start();
  double deepest = 0.0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    deepest = std::max(deepest, world.record().stats.max_penetration);
  }
  for (int i = 0; i < 5; ++i) CHECK((world.bodies()[i + 1].pose.position - Vec3(0.01 * i, i + 0.5, 0)).norm() < 1e-4);
  CHECK(deepest < 1e-5);
  CHECK(fastest(world) < 1e-6);
}

TEST_CASE("five balls of triangles on strings: the blow goes through to the last, and back to none") {
  constexpr double kRadius = 0.05, kString = 0.5, kAngle = M_PI / 6.0;
  for (const double gap : {1e-4, 1e-3}) {
    CAPTURE(gap);
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.contact.friction = 0.0;
    world.parameters.contact.restitution = 1.0;
    const SharedShape ball(surface(icosphere(3, kRadius)));
    for (int i = 0; i < 5; ++i) {
      const double x = i * (2.0 * kRadius + gap), angle = i == 0 ? kAngle : 0.0;
      BodyDescription d = dynamic_body("ball" + std::to_string(i), ball,
                                       Vec3(x - kString * std::sin(angle), -kString * std::cos(angle), 0.0));
      d.rotation.z() = -angle * 180.0 / M_PI;
      world.add_body(d);
      for (const double z : {-0.1, 0.1})
        world.add_attachment({fmt::format("string{}{}", i, z), d.name, "", Vec3(x, 0.0, z)});
    }
    world.start();
    for (int frame = 0; frame < 26; ++frame) world.step();
    const double most = 2.0 * kGravity * kString * (1.0 - std::cos(kAngle));  // v² at the bottom
    const double risen = kString + world.bodies()[4].pose.position.y();
    const double speed_sq = rigid(world, 4).velocity.squaredNorm() + 2.0 * kGravity * risen;
    CHECK(speed_sq == Approx(most).epsilon(0.05));
    for (int i = 0; i < 4; ++i) CHECK(rigid(world, i).velocity.norm() < 0.06 * std::sqrt(most));
  }
}

TEST_CASE("a finely cut hull over a floor of triangles touches with its lowest corner, however it flies and is sunk") {
  Random random(7);
  for (const int cut : {1, 2, 4})
    for (const double height : {3e-4, -1e-6, -3e-4, -8e-3, -0.03})
      for (const double spin : {0.0, 30.0}) {
        CAPTURE(cut, height, spin);
        World world;
        world.parameters.simulation.gravity = Vec3::Zero();
        world.parameters.simulation.substeps = 1;
        world.parameters.contact.second_looks = 0;  // what the first look finds, of the whole sub-step
        world.parameters.narrow_phase.continuous = Continuous::off;
        BodyDescription floor;
        floor.name = "floor";
        floor.kind = BodyKind::fixed;
        floor.shape = SharedShape(surface(box(Vec3(2.0, 0.1, 2.0), {20, 1, 20})));
        floor.position = Vec3(0.013, -0.1, 0.017);
        world.add_body(floor);
        const std::vector<Vec3> corners = icosphere(cut, 0.1).vertices;
        BodyDescription hull = dynamic_body("hull", made_hull(corners), Vec3::Zero());
        hull.rotation = 180.0 * random.vector();
        hull.angular_velocity = spin * random.vector();
        hull.velocity = Vec3(2.0, 0.0, -1.0);
        World lying;  // tells the attitude
        lying.add_body(hull);
        lying.start();
        double lowest = 1e300;
        for (const Vec3& x : corners) lowest = std::min(lowest, lying.bodies()[0].pose.apply(x).y());
        hull.position.y() = height - lowest;
        world.add_body(hull);
        world.start();
        world.step();
        double deepest = 1e300;
        for (const ContactRecord& c : world.record().contacts)
          if (std::abs(c.normal.y()) > 0.99) deepest = std::min(deepest, c.gap0);
        CHECK(deepest == Approx(height).margin(1e-9));
      }
}
