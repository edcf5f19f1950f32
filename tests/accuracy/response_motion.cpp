// What every response makes of motion that formulas know: rolling, pivoting, bouncing, sliding deformable pads, lost
// energy.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("balls and rods roll down an incline or slip, on both sides of the friction that rolling needs") {
  const double angle = M_PI / 6.0, radius = 0.2;
  const Vec3 normal(-std::sin(angle), std::cos(angle), 0.0), down(-std::cos(angle), -std::sin(angle), 0.0);
  for (const auto& e : responses())
    for (const bool rod : {false, true}) {
      BodyDescription body =
          dynamic_body("body", rod ? SharedShape(Capsule{radius, 0.3}) : SharedShape(Sphere{radius}), radius * normal);
      body.mass = 2.0;
      if (rod) body.rotation = Vec3(90, 0, 0);
      World probe;
      probe.add_body(body);
      const double k = 1.0 / (rigid(probe, 0).world_inertia()(2, 2) / (2.0 * radius * radius));  // m R²/I
      if (!rod) CHECK(k == Approx(2.5));
      const double needed = std::tan(angle) / (1.0 + k);
      for (const double mu : {1.05 * needed, 0.95 * needed}) {
        CAPTURE(e.name, rod, mu / needed);
        World world;
        use(world, e.name);
        world.parameters.contact.friction = mu;
        allow_iterations(world, 2000);
        world.add_body(fixed_plane("slope", normal, 0.0));
        world.add_body(body);
        world.start();
        run(world, 60);
        const RigidBody& b = rigid(world, 1);
        const double v = b.velocity.dot(down), spin = std::abs(b.angular_velocity().z()) * radius;
        const double exact = mu > needed ? kGravity * std::sin(angle) * k / (1.0 + k)
                                         : kGravity * (std::sin(angle) - mu * std::cos(angle));
        const double exact_spin = mu > needed ? exact : k * mu * kGravity * std::cos(angle);
        const double allowed = regularised(e.name) ? 1e-2 : 1e-5;  // springs carry nothing in the first sub-steps
        CHECK(v == Approx(exact).epsilon(allowed));
        CHECK(spin == Approx(exact_spin).epsilon(allowed));
      }
    }
}

TEST_CASE("twenty balls in a row that don't rebound fly on together, and no solve lacks its answer") {
  for (const auto& e : responses())
    for (const double friction : {0.0, 0.3})
      for (const int substeps : {1, 4}) {
        if (regularised(e.name)) continue;
        CAPTURE(e.name, friction, substeps);
        World world;
        use(world, e.name);
        world.parameters.simulation.gravity.setZero();
        world.parameters.simulation.substeps = substeps;
        world.parameters.contact.friction = friction;
        allow_iterations(world, 20000);
        for (int i = 0; i < 20; ++i) {
          BodyDescription ball =
              dynamic_body("ball" + std::to_string(i), Sphere{0.05}, {0.1 * i - (i == 0 ? 0.02 : 0.0), 0, 0});
          if (i == 0) ball.velocity = Vec3::UnitX();
          world.add_body(ball);
        }
        world.start();
        for (int frame = 0; frame < 20; ++frame) {
          world.step();
          CHECK(world.record().stats.unconverged == 0);
        }
        // 1e-8 of the blow, by the condition of a chain of twenty
        for (int i = 0; i < 20; ++i) CHECK((rigid(world, i).velocity - Vec3(0.05, 0, 0)).norm() < 1e-5);
      }
}

TEST_CASE("a box is pushed over the floor, twenty-five balls roll on it") {
  const double big = 10.0, small = 1.0, force = 150.0;
  const int balls = 25;
  const double f1 = 0.4 * (big + balls * small) * kGravity, f2 = (force - f1) / big / (3.5 / small + balls / big);
  const double a_box = (force - f1 - balls * f2) / big, a_ball = f2 / small;
  const Vec3 push = Vec3(0.5, 0, std::sqrt(0.75));
  for (const auto& e : responses()) {
    CAPTURE(e.name);
    World world;
    use(world, e.name);
    world.parameters.simulation.frame_time = 1e-3;
    world.parameters.simulation.substeps = 1;
    allow_iterations(world, 4000);
    BodyDescription floor = fixed_plane("floor", Vec3::UnitY(), 0.0);
    floor.friction = 0.2;  // 0.4 is the geometric mean with the box
    world.add_body(floor);
    BodyDescription box = dynamic_body("box", Box{Vec3(10, 0.05, 10)}, Vec3(0, 0.05, 0));
    box.mass = big;
    box.friction = 0.8;
    world.add_body(box);
    for (int i = 0; i < balls; ++i) {
      BodyDescription ball = dynamic_body("ball" + std::to_string(i), Sphere{0.2}, Vec3(i % 5 - 2, 0.3, i / 5 - 2));
      ball.mass = small;
      ball.friction = 0.8;
      world.add_body(ball);
    }
    world.start();
    double error = 0.0;
    const int steps = 150;
    for (int i = 1; i <= steps; ++i) {
      rigid(world, 1).velocity += 1e-3 * force / big * push;
      world.step();
      const double t = 1e-3 * i;
      error += ((rigid(world, 1).velocity - a_box * t * push).squaredNorm() +
                (rigid(world, 2).velocity - a_ball * t * push).squaredNorm()) /
               steps;
    }
    WARN(e.name << ": mean squared error of the pushed box and a ball " << error << " m²/s²");
    if (!regularised(e.name)) CHECK(error < 1e-6);
    CHECK(error < 1e-2);
  }
}

TEST_CASE("three legs hold a torque up to µ m g R, and slip beyond it") {
  const double radius = 1.5, mass = 3.0, mu = 2.0 / 3.0, g = 10.0, h = 0.01, inertia = 2.0;
  for (const auto& e : responses()) {
    if (regularised(e.name)) continue;
    for (const double torque : {20.0, 29.7, 30.3}) {
      CAPTURE(e.name, torque);
      GroupSystem group;
      RigidBlock block;
      block.inverse_mass = 1.0 / mass;
      block.inverse_inertia = Mat3::Identity() / inertia;
      block.velocity = {0, 0, -g * h};
      block.angular_velocity = {0, 0, torque * h / inertia};
      group.rigid = {block};
      for (int k = 0; k < 3; ++k) {
        ContactRows rows;
        const double a = 2.0 * M_PI * k / 3.0 + 0.1;
        rows.a.rigid = 0;
        rows.a.arm = radius * Vec3(std::cos(a), std::sin(a), 0);
        rows.directions << 0, 0, 1, 1, 0, 0, 0, 1, 0;
        rows.friction = mu;
        group.contacts.push_back(rows);
      }
      group.lambda.assign(3, Vec3::Zero());
      group.clear_delta();
      ResponseContext context;
      context.lcp = {1e-13, 100000};
      CHECK(patient_response(e.name, 100000)->solve(group, *lcp_solvers().front().make(), context).converged());
      const double spin = torque * h / inertia + group.delta_angular_velocity[0].z();
      if (torque < 30.0)
        CHECK(std::abs(spin) < 1e-10);
      else
        CHECK(spin == Approx((torque - 30.0) * h / inertia).epsilon(1e-6));
      for (const Vec3& lambda : group.lambda) {
        CHECK(lambda.x() == Approx(mass * g * h / 3.0).epsilon(1e-8));
        if (torque > 30.0) CHECK(lambda.tail<2>().norm() == Approx(mu * mass * g * h / 3.0).epsilon(1e-8));
      }
    }
  }
}

namespace {

/// Drops a ball from 1 m at h = 1e-4 s and checks when its bouncing ends; a penalty's bounce is its damper's, not e.
void check_bounce(std::string_view response, double e) {
  CAPTURE(response, e);
  World world;
  use(world, response);
  world.parameters.simulation.frame_time = 1e-4;
  world.parameters.simulation.substeps = 1;
  world.parameters.contact.restitution = e;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(dynamic_body("ball", Sphere{0.1}, Vec3(0, 1.1, 0)));
  world.start();
  const double fall = std::sqrt(2.0 / kGravity), total = fall * (1.0 + e) / (1.0 - e);
  int bounces = 0;
  double last = 0.0, before = 0.0;
  for (int i = 1; i < 1.1 * total / 1e-4; ++i) {
    world.step();
    const double v = rigid(world, 1).velocity.y();
    if (before < -0.05 && v > 0.0) {
      ++bounces;
      // either law is exact to what falls in a step
      CHECK(std::abs(v + e * before) < 1.1 * (1.0 + e) * kGravity * 1e-4);
    }
    if (std::abs(v) > 0.02) last = 1e-4 * i;
    before = v;
  }
  CHECK(bounces > 4);
  CHECK(last == Approx(total).epsilon(response == "quick" ? 2e-2 : 1e-2));
}

}  // namespace

TEST_CASE("a ball of restitution 0.5 stops bouncing after √(2h/g) (1+e)/(1-e)") {
  for (const auto& e : responses())
    if (e.name != "penalty") check_bounce(e.name, 0.5);
}

TEST_CASE("a ball of restitution 0.8 bounces for four seconds", "[long]") {
  for (const auto& e : responses())
    if (e.name != "penalty") check_bounce(e.name, 0.8);
}

TEST_CASE("three touching balls hit by one: responses that know one law for all contacts give (-1, 2, 2)/3") {
  for (const char* name : {"constraint_anticipation", "iterative_constraint_anticipation", "simultaneous_impulse"}) {
    CAPTURE(name);
    World world;
    use(world, name);
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.restitution = 1.0;
    world.parameters.contact.friction = 0.0;
    world.parameters.lcp.tolerance = 1e-13;
    allow_iterations(world, 10000);
    for (int i = 0; i < 3; ++i) {
      BodyDescription ball = dynamic_body("ball" + std::to_string(i), Sphere{0.1}, {0.2 * i, 0, 0});
      if (i == 0) ball.velocity = Vec3(1, 0, 0);
      world.add_body(ball);
    }
    world.start();
    world.step();
    const double expected[] = {-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0};
    for (int i = 0; i < 3; ++i) CHECK(rigid(world, i).velocity.x() == Approx(expected[i]).epsilon(1e-9));
  }
}

TEST_CASE("a deformable pad slides with µ ΣN against it, and sticks below that") {
  const double mu = 0.4;
  for (const auto& e : responses())
    for (const bool slips : {true, false}) {
      CAPTURE(e.name, slips);
      World world;
      use(world, e.name);
      world.parameters.contact.friction = mu;
      allow_iterations(world, 4000);
      set(world, "response.soft_constraint.iterations", 50);
      world.parameters.simulation.frame_time = 1.0 / 240.0;
      world.parameters.simulation.substeps = 1;  // so that every force is in the record
      world.parameters.simulation.gravity = slips ? Vec3(4.0, -kGravity, 0) : Vec3(0.25 * kGravity, -kGravity, 0);
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription pad =
          soft_box("pad", {0.02, 0.01, 0.02}, {2, 1, 2}, {0, 0, 0}, {1e5, 0.3, 1000.0, 0.01, "corotational"});
      if (slips) pad.velocity = Vec3(1.0, 0, 0);
      world.add_body(pad);
      world.start();
      run(world, 120);
      Vec3 sum = Vec3::Zero();
      const double before = deformable(world, 1).center_of_mass().x();
      const int frames = 120;
      for (int i = 0; i < frames; ++i) {
        world.step();
        sum += contact_force_on(world, 1) / frames;
      }
      const double moved = deformable(world, 1).center_of_mass().x() - before,
                   weight = kGravity * world.bodies()[1].mass;
      CHECK(sum.y() == Approx(weight).epsilon(1e-3));
      if (slips) {
        CHECK(-sum.x() == Approx(mu * sum.y()).epsilon(1e-3));
        CHECK(std::abs(sum.z()) < 1e-3 * sum.y());
      } else {
        CHECK(-sum.x() == Approx(0.25 * weight).epsilon(2e-3));
        // a regularised law creeps by less than ε f⁻¹(F_t/µN)
        CHECK(std::abs(moved) < (e.name == "penalty" ? 1e-3 * frames / 240.0 : 1e-6));
      }
    }
}

TEST_CASE("two deformable cubes that collide without friction and gravity: kinetic and elastic energy never rise") {
  for (const auto& e : responses()) {
    CAPTURE(e.name);
    World world;
    use(world, e.name);
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.linear_solver = "simplicial_llt";
    world.parameters.contact.friction = 0.0;
    world.parameters.lcp.tolerance = 1e-12;
    world.parameters.lcp.max_iterations = 20000;
    allow_iterations(world, 20000);
    for (const double side : {-1.0, 1.0}) {
      BodyDescription d =
          soft_cube(side < 0 ? "left" : "right", 0.2, side < 0 ? 1 : 2,
                    {side < 0 ? -0.21 : 0.01, 0.01 * side, 0.02 * side}, {1e5, 0.3, 1000.0, 0.0, "linear"});
      d.velocity = Vec3(-side, 0, 0);
      world.add_body(d);
    }
    world.start();
    const auto energy = [&] { return world.record().stats.kinetic + world.record().stats.elastic; };
    double before = energy(), rise = 0.0;
    const double first = before;
    std::int64_t contacts = 0;
    for (int i = 0; i < 40; ++i) {
      world.step();
      rise = std::max(rise, (energy() - before) / first);
      before = energy();
      contacts += world.record().stats.contacts;
    }
    CHECK(contacts > 0);
    CHECK(world.bodies()[0].twist().linear.x() < 0.5);
    if (regularised(e.name))
      WARN(e.name << ": largest rise of kinetic and elastic energy in a frame " << rise << " of what there was");
    else
      CHECK(rise < 1e-12);
  }
}

TEST_CASE("what lands flat leaves flat, with e times its speed, also by methods that go from contact to contact") {
  const std::vector<std::pair<const char*, SharedShape>> shapes = {{"box", Box{Vec3(0.1, 0.1, 0.1)}},
                                                                   {"slab", Box{Vec3(0.5, 0.1, 0.2)}}};
  for (const char* name : {"sequential_impulse", "simultaneous_impulse", "constraint_anticipation", "quick"})
    for (const auto& [what, shape] : shapes)
      for (const double friction : {0.0, 0.3})
        for (const double restitution : {0.4, 1.0}) {
          CAPTURE(name, what, friction, restitution);
          World world;
          use(world, name);
          world.parameters.simulation.gravity.setZero();
          world.parameters.contact.friction = friction;
          world.parameters.contact.restitution = restitution;
          world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
          BodyDescription body = dynamic_body("body", shape, Vec3(0, 0.2, 0));
          body.velocity = Vec3(0, -2, 0);
          world.add_body(body);
          world.start();
          run(world, 10);
          CHECK((rigid(world, 1).velocity - Vec3(0, 2.0 * restitution, 0)).norm() < 1e-5);
          CHECK(rigid(world, 1).angular_velocity().norm() < 1e-4);
        }
}

TEST_CASE("impulses that are shown are those of the whole sub-step, also where it is cut into pieces") {
  // what turns fast about a pin has sub-steps cut, also of what rests far from it
  for (const char* name : {"constraint_anticipation", "sequential_impulse", "quick"})
    for (const int substeps : {1, 4}) {
      CAPTURE(name, substeps);
      World world;
      use(world, name);
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription box = dynamic_body("box", Box{Vec3(0.5, 0.5, 0.5)}, Vec3(0, 0.5, 0));
      box.mass = 1.0;
      world.add_body(box);
      const double speed = 50.0;
      BodyDescription bar = dynamic_body("bar", Box{Vec3(0.5, 0.025, 0.025)}, Vec3(3.5, 3, 0));
      bar.mass = 1.0;
      bar.velocity = Vec3(0, 0.5 * speed, 0), bar.angular_velocity = Vec3(0, 0, speed);
      world.add_body(bar);
      world.add_attachment({"pin", "bar", "", Vec3(3, 3, 0)});
      world.start();
      const double h = world.parameters.simulation.frame_time / substeps;
      double least = INFINITY, most = 0.0, pull = 0.0, wanted = 0.0;
      for (int frame = 0; frame < 30; ++frame) {
        world.step();
        double impulse = 0.0;
        for (const ContactRecord& c : world.record().contacts) impulse += c.lambda.x();
        if (frame >= 10) least = std::min(least, impulse / h), most = std::max(most, impulse / h);
        pull += world.record().attachments.at(0).impulse.norm() / h;
        wanted += 0.5 * rigid(world, 2).angular_velocity().squaredNorm();  // m ω² r
      }
      CHECK(least == Approx(kGravity).epsilon(1e-3));
      CHECK(most == Approx(kGravity).epsilon(1e-3));
      CHECK(pull == Approx(wanted).epsilon(0.1));  // in the mean: the pin drifts and is taken back
    }
}

TEST_CASE("a bounce within a sub-step is shown with all of its impulse, though its bodies have parted by the end") {
  for (const double height : {0.11, 0.15, 0.2, 0.25}) {
    CAPTURE(height);
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.restitution = 1.0;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    world.add_body(fixed_plane("ceiling", -Vec3::UnitY(), -0.5));
    BodyDescription ball = dynamic_body("ball", Sphere{0.1}, Vec3(0, height, 0));
    ball.mass = 2.0;
    ball.velocity = Vec3(0, -10, 0);
    world.add_body(ball);
    world.start();
    // 0.3 m to and fro: 10 m/s * 1 s / 0.3 m = 33 impacts of 2 m v, one more or less
    double sum = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
      world.step();
      for (const ContactRecord& c : world.record().contacts) sum += c.lambda.x();
    }
    REQUIRE(world.bodies()[2].as<RigidBody>()->velocity.norm() == Approx(10.0).epsilon(1e-6));
    CHECK(sum == Approx(33 * 2.0 * 2.0 * 10.0).epsilon(0.04));
  }
}
