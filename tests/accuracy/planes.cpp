// What turns while it comes down on a plane touches it with other points than were lowest before.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/world/judge.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A body that comes down at `way` metres and `spin` radians a sub-step, until it has been there for some.
double deepest_of(const SharedShape& shape, const char* method, double way, double spin, double restitution,
                  Random& random) {
  constexpr double h = 1.0 / 60.0;
  World world;
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.parameters.contact.restitution = restitution;
  world.parameters.response.method = method;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  BodyDescription body = dynamic_body("body", shape, {0.3, shape->bounding_radius() + way * random.in(1.0, 3.0), 0.2});
  body.mass = 1.0;
  body.velocity = {0, -way / h, 0};
  body.angular_velocity = spin / h * random.direction();
  body.rotation = 180.0 * random.vector();
  world.add_body(body);
  world.start();
  double deepest = 0.0;
  for (int frame = 0; frame < 10; ++frame) {
    world.step();
    const RigidBody& now = *world.bodies()[1].as<RigidBody>();
    deepest = std::max(deepest, -now.shape->bounds(now.pose).min.y());
  }
  return deepest;
}

}  // namespace

TEST_CASE("what turns while it comes down on a plane ends nowhere below it") {
  Random random(11);
  for (const char* method : {"constraint_anticipation", "iterative_constraint_anticipation", "sequential_impulse"})
    for (const ShapeEntry& entry : shape_entries())
      for (int trial = 0; trial < 24; ++trial) {
        const SharedShape shape = sample_shape(random, entry);
        if (shape->as<Plane>() != nullptr) continue;
        const double way = std::pow(10.0, random.in(-1.0, 0.7)), spin = std::pow(10.0, random.in(-1.3, 0.5));
        CAPTURE(method, entry.name, trial, way, spin);
        CHECK(deepest_of(shape, method, way, spin, 0.4 * (trial % 3), random) < 1e-3 * shape->thickness());
      }
}

TEST_CASE("a ball that strikes a floor of triangles at many of its radii a sub-step leaves it as it leaves a plane") {
  const auto velocities = [](bool is_mesh, double way, const Vec3& spin, double friction, double restitution) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.substeps = 1;
    world.parameters.contact.friction = friction;
    world.parameters.contact.restitution = restitution;
    const double h = world.parameters.simulation.time_step();
    if (is_mesh) {
      BodyDescription slab = dynamic_body("floor", surface(box(Vec3(60.0, 5.0, 60.0), {12, 1, 12})), {0.7, -5.0, 0.3});
      slab.kind = BodyKind::fixed;
      world.add_body(slab);
    } else {
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    }
    BodyDescription ball = dynamic_body("ball", Sphere{1.0}, {0.08, 1.7, 0.3});
    ball.velocity = Vec3(0.3, -1.0, 0.1) * way / h;
    ball.angular_velocity = spin / h;
    world.add_body(ball);
    world.start();
    for (int frame = 0; frame < 4; ++frame) world.step();
    const Twist twist = world.bodies()[1].twist();
    return std::pair(Vec3(h * twist.linear), Vec3(h * twist.angular));
  };
  Random random(5);
  for (const double way : {0.5, 1.0, 2.0, 3.0, 5.0, 10.0})
    for (int trial = 0; trial < 8; ++trial) {
      const Vec3 spin = way * random.vector();
      const double friction = trial % 2 == 0 ? 0.0 : 0.3, restitution = trial % 4 < 2 ? 0.0 : 0.5;
      const auto on_plane = velocities(false, way, spin, friction, restitution),
                 on_mesh = velocities(true, way, spin, friction, restitution);
      CAPTURE(way, trial, friction, restitution);
      CHECK((on_mesh.first - on_plane.first).norm() < 1e-6 * way);
      CHECK((on_mesh.second - on_plane.second).norm() < 1e-6 * way);
    }
}
