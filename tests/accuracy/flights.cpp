// Bodies that fly together, or past each other, at up to many of their sizes a sub-step: against geometry, the formula of
// two balls, and the same in steps 256 times as short.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kStep = 1.0 / 60.0;

void prepare(World& world, double restitution) {
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.parameters.contact.friction = 0.0;
  world.parameters.contact.restitution = restitution;
}

double reach_of(const Shape& shape) {
  const Aabb box = shape.bounds({});
  return std::max(box.min.norm(), box.max.norm());
}

bool is_plane(const ShapeEntry& entry) { return std::string_view(entry.name) == "plane"; }

/// Angular momentum about the origin, of rigid bodies.
Vec3 angular_momentum(const World& world) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < world.bodies().size().value(); ++i) {
    const RigidBody& body = rigid(world, i);
    sum += body.pose.position.cross(body.mass * body.velocity) + body.angular_momentum;
  }
  return sum;
}

/// What becomes of a body that is shot at another, which is free: velocities when the two are apart again, and how often
/// that of the first changed.
struct Outcome {
  Vec3 velocity;
  int impacts = 0;
};

Outcome shoot(const BodyDescription& target, const BodyDescription& mover, double step, int steps) {
  World world;
  prepare(world, 1.0);
  world.parameters.simulation.frame_time = step;
  world.add_body(target);
  world.add_body(mover);
  world.start();
  Outcome outcome;
  outcome.velocity = mover.velocity;
  for (int i = 0; i < steps; ++i) {
    world.step();
    const Vec3 now = rigid(world, 1).velocity;
    outcome.impacts += (now - outcome.velocity).norm() > 1e-6 * mover.velocity.norm() ? 1 : 0;
    outcome.velocity = now;
  }
  return outcome;
}

}  // namespace

TEST_CASE("what flies past another keeps its way, whatever the two are, and so does the other") {
  const auto response = GENERATE(as<std::string>(), "", "sequential_impulse", "quick", "soft_constraint");
  Random random(3);
  for (const ShapeEntry& of_mover : shape_entries())
    for (const ShapeEntry& of_target : shape_entries()) {
      if (is_plane(of_mover) || is_plane(of_target)) continue;
      for (const double ways : {0.5, 2.0, 8.0})  // sizes a sub-step
        for (const bool is_free : {true, false}) {
          CAPTURE(response, of_mover.name, of_target.name, ways, is_free);
          const SharedShape mover_shape = sample_shape(random, of_mover),
                            target_shape = sample_shape(random, of_target);
          const double own = reach_of(*mover_shape), other = reach_of(*target_shape);
          const double speed = ways * 2.0 * own / kStep;
          const Mat3 axes = random.rotation();
          // beside the other by 1 to 30 % of its own size, and anywhere before it
          const double beside = target_shape->bounds({Mat3(axes.transpose()), Vec3::Zero()}).max.x() + own;
          World world;
          prepare(world, 0.5);
          if (!response.empty()) world.parameters.response.method = response;
          BodyDescription target = dynamic_body("target", target_shape, Vec3::Zero());
          if (!is_free) target.kind = BodyKind::fixed;
          BodyDescription mover = dynamic_body("mover", mover_shape, Vec3::Zero());
          mover.position = axes * Vec3(beside + random.in(0.02, 0.6) * own, other + own + random.u() * speed * kStep,
                                       0.5 * other * random.sym());
          mover.rotation = 180.0 * random.vector();
          mover.velocity = -speed * axes.col(1);
          world.add_body(target);
          world.add_body(mover);
          world.start();
          run(world, 3 + static_cast<int>((2.0 * (own + other) + speed * kStep) / (speed * kStep)));
          CHECK((world.bodies()[1].twist().linear - mover.velocity).norm() <= 1e-12 * speed);
          CHECK(world.bodies()[1].twist().angular.norm() * own <= 1e-12 * speed);
          CHECK(world.bodies()[0].twist().linear.norm() <= 1e-12 * speed);
        }
    }
}

TEST_CASE("two balls that meet aslant part as the formula says, wherever in the sub-step they meet") {
  constexpr double kRadius = 0.1;
  const auto velocities = GENERATE(VelocityTime::end, VelocityTime::middle);
  for (const double restitution : {0.0, 0.5, 1.0})
    for (const double ways : {0.1, 0.5, 2.0, 8.0}) {  // diameters a sub-step
      Random random(5);
      for (int k = 0; k < 30; ++k) {
        const double speed = ways * 2.0 * kRadius / kStep, aside = random.in(0.0, 0.95) * 2.0 * kRadius;
        CAPTURE(restitution, ways, aside);
        World world;
        prepare(world, restitution);
        world.parameters.simulation.velocities = velocities;
        world.add_body(dynamic_body("one", Sphere{kRadius}, Vec3::Zero()));
        BodyDescription other = dynamic_body("other", Sphere{kRadius},
                                             Vec3(-2.0 * kRadius - 0.05 - random.u() * speed * kStep, aside, 0.0));
        other.velocity = Vec3(speed, 0.0, 0.0);
        world.add_body(other);
        world.start();
        const Vec3 turning = angular_momentum(world);
        const double mass = rigid(world, 0).mass;
        const int frames = 3 + static_cast<int>((4.0 * kRadius + 0.1 + speed * kStep) / (speed * kStep));
        run(world, frames);

        const Vec3 meet(-std::sqrt(4.0 * kRadius * kRadius - aside * aside), aside, 0.0), normal = meet.normalized();
        const Vec3 change = -(1.0 + restitution) * 0.5 * normal.dot(other.velocity) * normal;
        const double after = frames * kStep - (meet - other.position).x() / speed;
        const Vec3 place = meet + after * (other.velocity + change);
        const RigidBody &one = rigid(world, 0), &two = rigid(world, 1);
        CHECK((two.velocity - other.velocity - change).norm() < 4e-3 * speed);
        CHECK((one.velocity + change).norm() < 4e-3 * speed);
        CHECK((two.pose.position - place).norm() < 4e-3 * speed * after + 1e-3 * kRadius);
        CHECK((one.velocity + two.velocity - other.velocity).norm() < 1e-13 * speed);
        CHECK(two.angular_velocity().norm() * kRadius < 1e-12 * speed);
        CHECK((angular_momentum(world) - turning).norm() < 1e-12 * mass * speed * kRadius * (1.0 + ways));
      }
    }
}

TEST_CASE(
    "two balls that begin nearly in touch part as the formula says, and those that miss each other keep their way") {
  constexpr double kRadius = 0.1, kApart = 2.0 * kRadius;
  Random random(9);
  for (const double ways : {0.05, 0.5, 5.0, 50.0})      // diameters a sub-step
    for (const double part : {0.05, 0.5, 0.9, 0.9999})  // of the activation distance
      for (const bool is_hit : {true, false})
        for (int k = 0; k < 8; ++k) {
          World world;
          prepare(world, 1.0);
          const double gap = part * world.parameters.contact.activation_distance.at(kApart), begin = kApart + gap,
                       aside = is_hit ? random.in(0.0, 0.99) * kApart : kApart + random.in(0.05, 0.95) * gap;
          CAPTURE(ways, part, aside);
          const double speed = ways * kApart / kStep;
          world.add_body(dynamic_body("one", Sphere{kRadius}, Vec3::Zero()));
          BodyDescription other =
              dynamic_body("other", Sphere{kRadius}, Vec3(-std::sqrt(begin * begin - aside * aside), aside, 0.0));
          other.velocity = Vec3(speed, 0.0, 0.0);
          world.add_body(other);
          world.start();
          run(world, 3);
          Vec3 change = Vec3::Zero();
          if (is_hit) {
            const Vec3 normal = Vec3(-std::sqrt(kApart * kApart - aside * aside), aside, 0.0).normalized();
            change = -normal.dot(other.velocity) * normal;
          }
          CHECK((rigid(world, 1).velocity - other.velocity - change).norm() <= 1e-3 * speed);
          CHECK((rigid(world, 0).velocity + change).norm() <= 1e-3 * speed);
          if (!is_hit) CHECK(rigid(world, 0).velocity.norm() <= 1e-12 * speed);
        }
}

TEST_CASE("a crowd that flies together keeps its momentum and angular momentum to rounding") {
  const auto kind = GENERATE(0, 1, 2);
  for (const double restitution : {0.0, 0.5, 1.0})
    for (const double speed : {1.0, 5.0, 20.0}) {
      CAPTURE(kind, restitution, speed);
      World world;
      prepare(world, restitution);
      world.parameters.contact.friction = 0.3;
      Random random(7);
      double scale = 0.0;
      for (int i = 0; i < 27; ++i) {
        const SharedShape shape = kind == 0   ? SharedShape(Sphere{0.2})
                                  : kind == 1 ? SharedShape(Box{Vec3(0.2, 0.15, 0.1)})
                                              : SharedShape(surface(icosphere(1, 0.2)));
        const Vec3 at = 0.9 * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) + 0.05 * random.vector();
        BodyDescription body = dynamic_body("body" + std::to_string(i), shape, at);
        body.velocity = -speed * at + 0.3 * speed * random.vector();
        body.angular_velocity = 0.5 * speed * random.vector();
        world.add_body(body);
      }
      world.start();
      Vec3 before = Vec3::Zero();
      for (int i = 0; i < 27; ++i) {
        const RigidBody& body = rigid(world, i);
        before += body.mass * body.velocity;
        scale += body.mass * body.velocity.norm();
      }
      const Vec3 turning = angular_momentum(world);
      run(world, 40);
      Vec3 after = Vec3::Zero();
      for (int i = 0; i < 27; ++i) after += rigid(world, i).mass * rigid(world, i).velocity;
      CHECK((after - before).norm() <= 1e-12 * scale);
      CHECK((angular_momentum(world) - turning).norm() <= 1e-11 * scale);
    }
}

TEST_CASE("where one impact is all that happens, a sub-step of two sizes makes the same of it as one of a hundredth") {
  std::vector<double> errors;  // of the speed
  for (const ShapeEntry& of_mover : shape_entries())
    for (const ShapeEntry& of_target : shape_entries()) {
      if (is_plane(of_mover) || is_plane(of_target) || std::string_view(of_mover.name) > of_target.name) continue;
      Random random(11);
      for (const double ways : {0.1, 0.5, 2.0})
        for (int k = 0; k < 6; ++k) {
          const SharedShape mover_shape = sample_shape(random, of_mover),
                            target_shape = sample_shape(random, of_target);
          const double own = reach_of(*mover_shape), other = reach_of(*target_shape), speed = ways * 2.0 * own / kStep;
          BodyDescription target = dynamic_body("target", target_shape, Vec3::Zero());
          BodyDescription mover = dynamic_body("mover", mover_shape, Vec3::Zero());
          const double aside = 0.7 * std::min(own, other);
          mover.position =
              Vec3(-(own + other) - 0.02 - random.u() * speed * kStep, aside * random.sym(), aside * random.sym());
          mover.velocity = Vec3(speed, 0.0, 0.0);
          mover.rotation = 180.0 * random.vector();
          target.rotation = 180.0 * random.vector();
          const int steps = 3 + static_cast<int>((2.0 * (own + other) + 0.1 + speed * kStep) / (speed * kStep));
          const Outcome fine = shoot(target, mover, kStep / 256.0, 256 * steps);
          if (fine.impacts > 1) continue;
          const Outcome coarse = shoot(target, mover, kStep, steps);
          errors.push_back((coarse.velocity - fine.velocity).norm() / speed);
        }
    }
  // what is left: a body that is struck turns, and within the rest of a long sub-step another place of it may strike
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size()))];
  };
  CAPTURE(errors.size(), at(0.5), at(0.9), at(0.95), at(0.98), errors.back());
  CHECK(errors.size() > 300);
  CHECK(at(0.5) < 2e-4);
  CHECK(at(0.95) < 0.01);
}

TEST_CASE("two balls on a floor that meet aslant part as the formula says, and stay on it") {
  constexpr double kRadius = 0.1;
  for (const bool is_plane : {true, false})
    for (const double restitution : {0.0, 1.0})
      for (const double ways : {0.1, 0.5, 2.0}) {  // diameters a sub-step
        Random random(9);
        for (int k = 0; k < 12; ++k) {
          const double speed = ways * 2.0 * kRadius / kStep, aside = random.in(0.0, 0.9) * 2.0 * kRadius;
          CAPTURE(is_plane, restitution, ways, aside);
          World world;
          prepare(world, restitution);
          world.parameters.simulation.gravity = Vec3(0.0, -kGravity, 0.0);
          BodyDescription floor = fixed_plane("floor", Vec3::UnitY(), 0.0);
          if (!is_plane) floor.shape = Box{Vec3(200.0, 1.0, 200.0)}, floor.position = Vec3(0.0, -1.0, 0.0);
          world.add_body(floor);
          world.add_body(dynamic_body("one", Sphere{kRadius}, Vec3(0.0, kRadius, 0.0)));
          BodyDescription other = dynamic_body(
              "other", Sphere{kRadius}, Vec3(-2.0 * kRadius - 0.05 - random.u() * speed * kStep, kRadius, aside));
          other.velocity = Vec3(speed, 0.0, 0.0);
          world.add_body(other);
          world.start();
          const int frames = 3 + static_cast<int>((4.0 * kRadius + 0.1 + speed * kStep) / (speed * kStep));
          run(world, frames);
          const Vec3 normal = Vec3(-std::sqrt(4.0 * kRadius * kRadius - aside * aside), 0.0, aside).normalized();
          const Vec3 change = -(1.0 + restitution) * 0.5 * normal.dot(other.velocity) * normal;
          CHECK((rigid(world, 2).velocity - other.velocity - change).norm() < 4e-3 * speed);
          CHECK((rigid(world, 1).velocity + change).norm() < 4e-3 * speed);
          for (const int i : {1, 2}) CHECK(std::abs(rigid(world, i).pose.position.y() - kRadius) < 1e-3 * kRadius);
        }
      }
}

TEST_CASE(
    "a ball that strikes a floor aslant leaves with the spin that its own arm gives it, however far off it was seen") {
  constexpr double kRadius = 0.1, kFriction = 0.1;
  const auto response = GENERATE(as<std::string>(), "", "sequential_impulse", "quick", "soft_constraint");
  for (const double restitution : {0.5, 1.0})
    for (const double off : {0.001, 0.003, 0.0097, 0.016})  // of what is covered in a sub-step, 0.0167 m
      for (const bool is_first : {true, false}) {
        CAPTURE(response, restitution, off, is_first);
        World world;
        world.parameters.simulation.gravity.setZero();
        world.parameters.simulation.sleeping = false;
        world.parameters.contact.restitution = restitution, world.parameters.contact.friction = kFriction;
        if (!response.empty()) world.parameters.response.method = response;
        BodyDescription ball = dynamic_body("ball", Sphere{kRadius}, {0, kRadius + off, 0});
        ball.velocity = {3, -4, 0};
        if (is_first) world.add_body(ball);
        world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
        if (!is_first) world.add_body(ball);
        world.start();
        run(world, 6);
        const Twist after = world.bodies()[is_first ? 0 : 1].twist();
        const double slowed = kFriction * (1.0 + restitution) * 4.0;  // it slips all the while
        CHECK(after.linear.x() == Approx(3.0 - slowed).epsilon(1e-6));
        CHECK(after.linear.y() == Approx(4.0 * restitution).epsilon(1e-6));
        CHECK(after.angular.z() == Approx(-slowed / (0.4 * kRadius)).epsilon(1e-5));
      }
}
