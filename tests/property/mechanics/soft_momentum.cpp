// Momentum of deformable bodies that nothing holds, whose velocities an iteration finds.
#include <catch2/catch.hpp>

#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

Vec3 momentum(const World& world, double* size = nullptr) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 2; ++i) {
    const Vec3 own = deformable(world, i).momentum();
    sum += own;
    if (size != nullptr) *size += own.norm();
  }
  return sum;
}

}  // namespace

TEST_CASE("soft bodies that collide in nothing keep their momentum, however roughly a linear solve ends") {
  for (const char* method : {"constraint_anticipation", "penalty", "sequential_impulse"})
    for (const char* integrator : {"implicit_euler", "linearly_implicit_euler", "energy_momentum"}) {
      World world;
      world.parameters.simulation.gravity = Vec3::Zero();
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.integrator = integrator;
      world.parameters.contact.friction = 0.0;
      world.parameters.response.method = method;
      BodyDescription a = soft_cube("a", 0.2, 3, {0, 0, 0}, {1e6, 0.3, 1000.0, 0.002, "corotational"});
      a.velocity = {1.0, 0.1, 0.0};
      BodyDescription b = soft_cube("b", 0.2, 3, {0.22, 0.05, 0.03}, {1e5, 0.3, 1000.0, 0.002, "neo_hookean"});
      b.velocity = {-1.0, 0.0, 0.0};
      world.add_body(a);
      world.add_body(b);
      world.start();
      double size = 0.0;
      const Vec3 before = momentum(world, &size);
      double drift = 0.0;
      std::int64_t contacts = 0;
      for (int frame = 0; frame < 30; ++frame) {
        world.step();
        drift = std::max(drift, (momentum(world) - before).norm() / size);
        contacts = std::max(contacts, world.record().stats.contacts);
      }
      CAPTURE(method, integrator, drift);
      CHECK(contacts > 3);
      CHECK(drift <= 1e-10);
    }
}
