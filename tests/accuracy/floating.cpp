// Bodies that nothing but one another holds: whatever they do to each other, they end with no more energy than they had,
// the momentum that they had, and the angular momentum.
#include <catch2/catch.hpp>

#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kFloatStep = 1.0 / 60.0;

struct Sums {
  double energy = 0.0;
  Vec3 momentum = Vec3::Zero(), turning = Vec3::Zero();  // about the origin
  double size = 0.0;                                     // of momenta
};

Sums sums_of(const World& world) {
  Sums all;
  for (const Body& b : world.bodies()) {
    const RigidBody& body = *b.as<RigidBody>();
    const Vec3 p = body.mass * body.velocity;
    all.energy += 0.5 * p.dot(body.velocity) + 0.5 * body.angular_momentum.dot(body.angular_velocity());
    all.momentum += p;
    all.turning += body.pose.position.cross(p) + body.angular_momentum;
    all.size += p.norm() + body.angular_momentum.norm();
  }
  return all;
}

SharedShape any_shape(Random& random) {
  const auto entries = shape_entries();
  for (;;) {
    const ShapeEntry& entry = entries[static_cast<std::size_t>(random.below(static_cast<int>(entries.size())))];
    if (std::string_view(entry.name) != "plane") return sample_shape(random, entry);
  }
}

/// `count` bodies of any shape that come together from all round with spins, `reach` metres from where they meet.
void add_bodies(World& world, Random& random, int count, double reach, double speed) {
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * (i + 0.2 * random.sym()) / count;
    const Vec3 at(reach * std::cos(angle), reach * std::sin(angle), 0.3 * random.sym());
    BodyDescription body = dynamic_body("body" + std::to_string(i), any_shape(random), at);
    body.density = 1000.0 * std::pow(10.0, random.in(-1.0, 1.0));
    body.rotation = 180.0 * random.vector();
    body.velocity = -speed * at.normalized() + 0.1 * speed * random.vector();
    body.angular_velocity = speed * random.vector();
    world.add_body(body);
  }
}

void prepare(World& world, const std::string& response, double restitution, int substeps) {
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.contact.restitution = restitution;
  if (!response.empty()) world.parameters.response.method = response;
}

}  // namespace

TEST_CASE("what floats wins no energy, with whatever it is answered") {
  const auto response = GENERATE(as<std::string>(), "quick", "soft_constraint");
  for (const double restitution : {0.0, 0.5, 1.0})
    for (int seed = 1; seed <= 40; ++seed) {
      Random random(seed);
      const double speed = std::pow(10.0, random.in(0.0, 2.3));  // 0.02 to 3 sizes a sub-step
      const int substeps = 1 << random.below(5), count = 2 + random.below(2);
      CAPTURE(response, restitution, seed, speed, substeps, count);
      World world;
      prepare(world, response, restitution, substeps);
      add_bodies(world, random, count, 2.0, speed);
      world.start();
      const Sums before = sums_of(world);
      const int frames = 4 + static_cast<int>(4.0 / (speed * kFloatStep));
      for (int i = 0; i < std::min(frames, 60); ++i) {
        world.step();
        const Sums now = sums_of(world);
        REQUIRE(now.energy <= before.energy * (1.0 + 1e-9));
        REQUIRE((now.momentum - before.momentum).norm() <= 1e-11 * before.size);
      }
    }
}

TEST_CASE("what floats wins no energy where it begins in another and rebounds") {
  double most_turned = 0.0;
  for (int seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const double speed = std::pow(10.0, random.in(0.0, 1.5));
    const int substeps = 1 << random.below(3);
    CAPTURE(seed, speed, substeps);
    World world;
    prepare(world, "", 1.0, substeps);
    add_bodies(world, random, 2, 0.45, speed);
    world.start();
    const Sums before = sums_of(world);
    for (int i = 0; i < 12; ++i) {
      world.step();
      const Sums now = sums_of(world);
      REQUIRE(now.energy <= before.energy * (1.0 + 1e-6));
      REQUIRE((now.momentum - before.momentum).norm() <= 1e-11 * before.size);
      most_turned = std::max(most_turned, (now.turning - before.turning).norm() / before.size);
    }
  }
  CHECK(most_turned < 0.1);  // of overlaps as large as bodies
}
