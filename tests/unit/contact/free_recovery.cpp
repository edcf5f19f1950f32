// Bodies of a group that floats, put elsewhere: momentum, angular momentum and energy by sums of their own, over the point
// masses at the ends of each body's axes.
#include "engine/contact/recovery/free_recovery.hpp"

#include <catch2/catch.hpp>

#include "engine/bodies/rigid_body.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Sums {
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();  // about the centre that the bodies had to begin with
  double energy = 0.0, size = 0.0;
};

/// Six masses on the principal axes have the inertia of a box.
Sums sums_of(const World& world, const Vec3& center) {
  Sums all;
  for (const Body& b : world.bodies()) {
    const RigidBody& body = *b.as<RigidBody>();
    for (int k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0}) {
        const Vec3 moments = body.inertia.diagonal();
        const double mass = body.mass / 6.0, reach = std::sqrt(0.5 * (0.5 * moments.sum() - moments[k]) / mass);
        const Vec3 arm = side * reach * body.pose.rotation.col(k),
                   velocity = body.velocity + body.angular_velocity().cross(arm);
        all.momentum += mass * velocity;
        all.spin += mass * (body.pose.position + arm - center).cross(velocity);
        all.energy += 0.5 * mass * velocity.squaredNorm();
        all.size += mass * velocity.norm();
      }
  }
  return all;
}

struct Floating {
  World world;
  std::vector<BodyIndex> group;
  std::vector<BodyVector> by;
  Vec3 center = Vec3::Zero();
  double mass = 0.0;

  /// Of sizes and masses of two decades, each displaced by about `far` of its size, their centre not.
  Floating(int seed, double far) {
    Random random(seed);
    const int count = 2 + seed % 4;
    for (int i = 0; i < count; ++i) {
      const Vec3 half(random.in(0.1, 0.5), random.in(0.1, 0.5), random.in(0.1, 0.5));
      BodyDescription body = dynamic_body("body" + std::to_string(i), Box{half}, 2.0 * random.vector());
      body.density = std::pow(10.0, random.in(2.0, 4.0));
      body.rotation = 180.0 * random.vector();
      body.velocity = Vec3(3.0, -2.0, 1.0) + random.vector();
      body.angular_velocity = 2.0 * random.vector();
      world.add_body(body);
    }
    world.start();
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < count; ++i) {
      const RigidBody& body = rigid(world, i);
      group.emplace_back(i);
      by.push_back({{far * random.vector(), far * random.vector()}, {}});
      mass += body.mass, center += body.mass * body.pose.position, mean += body.mass * by.back().twist.linear;
    }
    center /= mass;
    for (BodyVector& b : by) b.twist.linear -= mean / mass;
  }
};

}  // namespace

TEST_CASE("a recovery of floating bodies keeps momentum and angular momentum where contact took energy", "[contact]") {
  for (const double far : {1e-6, 1e-3, 0.1})
    for (int seed = 1; seed <= 40; ++seed) {
      CAPTURE(far, seed);
      Floating f(seed, far);
      const Sums before = sums_of(f.world, f.center);
      displace_floating(f.world.bodies(), f.group, f.by, 10.0 * before.energy);
      const Sums after = sums_of(f.world, f.center);
      CHECK((after.momentum - before.momentum).norm() <= 1e-12 * before.size);
      CHECK((after.spin - before.spin).norm() <= 1e-11 * before.size);
    }
}

TEST_CASE("a recovery of floating bodies wins no energy, and a small one still keeps angular momentum", "[contact]") {
  for (const double far : {1e-9, 1e-6, 1e-4, 0.1, 1.0})
    for (int seed = 1; seed <= 40; ++seed) {
      CAPTURE(far, seed);
      Floating f(seed, far);
      const Sums before = sums_of(f.world, f.center);
      displace_floating(f.world.bodies(), f.group, f.by, 0.0);
      const Sums after = sums_of(f.world, f.center);
      CHECK((after.momentum - before.momentum).norm() <= 1e-12 * before.size);
      CHECK(after.energy <= before.energy * (1.0 + 1e-12));
      if (far <= 1e-4) CHECK((after.spin - before.spin).norm() <= 1e-11 * before.size);
      const double inner = before.energy - 0.5 * before.momentum.squaredNorm() / f.mass;
      if (far <= 1e-4) CHECK(after.energy >= before.energy - 4e-3 * inner);
    }
}

TEST_CASE("a recovery of floating bodies puts them where it says", "[contact]") {
  Floating f(7, 0.2);
  std::vector<Pose> before;
  for (const BodyIndex b : f.group) before.push_back(f.world.bodies()[b].pose);
  displace_floating(f.world.bodies(), f.group, f.by, 0.0);
  for (std::size_t i = 0; i < f.group.size(); ++i) {
    const Pose& now = f.world.bodies()[f.group[i]].pose;
    const Vec3& turn = f.by[i].twist.angular;
    const Mat3 turned = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * before[i].rotation;
    CHECK((now.position - before[i].position - f.by[i].twist.linear).norm() < 1e-14);
    CHECK((now.rotation - turned).norm() < 1e-12);
  }
}
