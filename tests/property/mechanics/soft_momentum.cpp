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

TEST_CASE(
    "a damped soft cube that hits a rod in nothing makes angular momentum as the sub-step is long, and none beyond") {
  const auto lost = [](const char* integrator, const char* model, int substeps) {
    World world;
    world.parameters.simulation.gravity = Vec3::Zero();
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.integrator = integrator;
    world.parameters.simulation.substeps = substeps;
    world.parameters.contact.friction = 0.5;
    const Vec3 spin(5.0, -3.0, 4.0);
    BodyDescription cube = soft_cube("cube", 0.1, 3, {-0.12, 0.02, 0.01}, {5e4, 0.4, 1000.0, 0.003, model});
    cube.rotation = {20.0, 30.0, 40.0};
    cube.velocity = {3.0, 0.1, 0.0};
    cube.angular_velocity = spin;
    BodyDescription rod = dynamic_body("rod", Box{Vec3(0.03, 0.08, 0.03)}, {0.12, 0.05, 0.05});
    rod.velocity = {-3.0, 0.1, 0.0};
    rod.angular_velocity = spin;
    world.add_body(cube);
    world.add_body(rod);
    world.start();
    const auto turning = [&] { return Vec3(world.record().stats.angular_momentum); };
    const Vec3 before = turning();
    std::int64_t contacts = 0;
    for (int frame = 0; frame < 12; ++frame) {
      world.step();
      contacts = std::max(contacts, world.record().stats.contacts);
    }
    CHECK(contacts > 0);
    return (turning() - before).norm() / (0.01 / 6.0 * spin.norm());  // 1 kg, 0.1 m
  };
  const auto is_of_the_step = [&](const char* integrator, const char* model) {
    const double coarse = lost(integrator, model, 32), fine = lost(integrator, model, 128);
    CAPTURE(integrator, model, coarse, fine);
    CHECK(fine < 0.06);
    CHECK(fine < 0.5 * coarse);  // a quarter, as soon as the first order is all of it
  };
  for (const char* integrator : {"linearly_implicit_euler", "implicit_euler", "newmark", "energy_momentum"})
    is_of_the_step(integrator, "corotational");
  for (const char* model : {"neo_hookean", "fixed_corotated", "mass_spring"})
    is_of_the_step("linearly_implicit_euler", model);
}
