// Flight without contact: the integrator's own closed form and the constants of free rotation.
#include <catch2/catch.hpp>

#include "engine/integrators/rigid_motion.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("ballistic flight follows the closed form of the integrator") {
  World world;
  world.parameters.simulation.substeps = 3;
  const Vec3 x0(0.3, 5.0, -1.0), v0(2.0, 7.0, -1.5), g = world.parameters.simulation.gravity;
  BodyDescription d = dynamic_body("ball", Sphere{0.1}, x0);
  d.velocity = v0;
  world.add_body(d);
  world.start();
  const double h = world.parameters.simulation.time_step();
  double travelled = 0.0;
  Vec3 last = x0;
  for (int frame = 1; frame <= 400; ++frame) {
    world.step();
    const double n = 3.0 * frame;
    // x_n = x0 + n h v0 + h² g n (n + 1) / 2: velocities first, then positions
    const Vec3 expected = x0 + n * h * v0 + h * h * g * (0.5 * n * (n + 1.0));
    travelled += (world.bodies()[0].pose.position - last).norm();
    last = world.bodies()[0].pose.position;
    REQUIRE((last - expected).norm() <= 1e-12 * travelled);
    REQUIRE((world.bodies()[0].velocity - (v0 + n * h * g)).norm() <= 1e-12 * (v0 + n * h * g).norm());
  }
}

TEST_CASE("a free tumbling bunny keeps its angular momentum") {
  World world;
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.substeps = 1;
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = read_mesh(IMPINGE_SOURCE_DIR "/scenes/meshes/bunny/bunny.off");
  surface->topology = make_topology(surface->mesh);
  BodyDescription d = dynamic_body("bunny", MeshPointer(surface), Vec3(1, 2, 3));
  d.angular_velocity = Vec3(5.0, -3.0, 8.0);
  d.velocity = Vec3(0.1, 0.2, -0.3);
  RigidBody& bunny = world.add_body(d);
  const auto energy = [&] { return 0.5 * bunny.angular_momentum.dot(bunny.angular_velocity()); };
  world.start();
  const Vec3 l0 = world.record().stats.angular_momentum, spin0 = bunny.angular_momentum;
  const double e0 = energy();
  run(world, 1000);
  CHECK((world.record().stats.angular_momentum - l0).norm() < 1e-9 * l0.norm());
  CHECK((bunny.angular_momentum - spin0).norm() == 0.0);
  CHECK(std::abs(energy() - e0) < 1e-3 * e0);
}

TEST_CASE("a body spun about its middle axis flips over and over, momentum and energy kept") {
  // inertia 1 : 2 : 3; the middle axis is unstable (Dzhanibekov), the others are stable
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    RigidBody body;
    body.mass = 1.0;
    body.inertia = Vec3(1.0, 2.0, 3.0).asDiagonal();
    body.inertia_inverse = Vec3(1.0, 0.5, 1.0 / 3.0).asDiagonal();
    body.angular_momentum = body.inertia * (10.0 * Vec3::Unit(axis) + 1e-3 * Vec3::Ones());
    const Vec3 l0 = body.angular_momentum;
    const double e0 = 0.5 * l0.dot(body.angular_velocity());
    double lowest = 1.0, worst_energy = 0.0;
    for (int i = 0; i < 1000; ++i) {
      advance_rigid(body, 0.01);
      worst_energy =
          std::max(worst_energy, std::abs(0.5 * body.angular_momentum.dot(body.angular_velocity()) - e0) / e0);
      lowest = std::min(lowest, body.pose.rotation.col(axis).dot(l0.normalized()));
    }
    CHECK((body.angular_momentum - l0).norm() / l0.norm() < 1e-9);
    CHECK(worst_energy < 1e-3);
    if (axis == 1) CHECK(lowest < -0.9);   // it has turned over
    if (axis != 1) CHECK(lowest > 0.999);  // it has not
    CHECK((body.pose.rotation * body.pose.rotation.transpose() - Mat3::Identity()).norm() < 1e-13);
  }
}

TEST_CASE("the rotation error falls with the square of the step") {
  const auto end = [](double h) {
    RigidBody body;
    body.mass = 1.0;
    body.inertia = Vec3(1.0, 2.0, 3.0).asDiagonal();
    body.inertia_inverse = Vec3(1.0, 0.5, 1.0 / 3.0).asDiagonal();
    body.angular_momentum = Vec3(1.0, 2.0, 0.5);
    for (int i = 0, n = static_cast<int>(std::lround(2.0 / h)); i < n; ++i) advance_rigid(body, h);
    return body.pose.rotation;
  };
  const Mat3 truth = end(1e-4);
  const double coarse = (end(0.02) - truth).norm(), fine = (end(0.01) - truth).norm();
  CHECK(coarse / fine == Approx(4.0).epsilon(0.05));
}
