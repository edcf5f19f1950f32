// Flight without contact: the integrator's own closed form, the constants of free rotation and its attitudes.
#include <catch2/catch.hpp>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

RigidBody spinning(const Vec3& moments, const Mat3& rotation, const Vec3& own_angular_velocity) {
  RigidBody body;
  body.mass = 1.0;
  body.set_inertia(moments.asDiagonal());
  body.pose.rotation = rotation;
  body.angular_momentum = rotation * moments.cwiseProduct(own_angular_velocity);
  return body;
}

/// From the moments themselves: what the body makes of them is under test too.
double energy(const RigidBody& body, const Vec3& moments) {
  const Vec3 own = body.pose.rotation.transpose() * body.angular_momentum;
  return 0.5 * own.dot(own.cwiseQuotient(moments));
}

struct Inertia {
  const char* name;
  Vec3 moments;
};

std::vector<Inertia> inertias(double ratio) {
  return {{"needle", {ratio, 1.0, ratio}},
          {"three axes", {std::sqrt(ratio), ratio, 1.0}},
          {"flat needle", {1.0, ratio, 0.9 * ratio}},
          {"nearly a needle", {ratio, 1.0, ratio * (1.0 - 1e-9)}},
          {"disc", {1.0, ratio, 1.0}},
          {"nearly a disc", {1.0, ratio, 1.0 + 1e-9}}};
}

/// R' = [w]x R by the classical Runge-Kutta method in long double, steps below 1/1,000 rad: 1e-13 off after ten.
Mat3 by_small_steps(const Vec3& moments, const Mat3& rotation, const Vec3& momentum, double time) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  using Matrix = Eigen::Matrix<long double, 3, 3>;
  const Vector l = momentum.cast<long double>(), inverse = moments.cast<long double>().cwiseInverse();
  const auto rate = [&](const Matrix& r) -> Matrix {
    const Vector w = r * inverse.cwiseProduct(r.transpose() * l);
    Matrix cross;
    cross << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    return cross * r;
  };
  const int steps = 1 + static_cast<int>(1000.0 * time * momentum.norm() / moments.minCoeff());
  const long double h = static_cast<long double>(time) / steps;
  Matrix r = rotation.cast<long double>();
  for (int i = 0; i < steps; ++i) {
    const Matrix k1 = rate(r), k2 = rate(r + h / 2 * k1), k3 = rate(r + h / 2 * k2), k4 = rate(r + h * k3);
    r += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return r.cast<double>();
}

}  // namespace

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
    REQUIRE((rigid(world, 0).velocity - (v0 + n * h * g)).norm() <= 1e-12 * (v0 + n * h * g).norm());
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
  world.add_body(d);
  RigidBody& bunny = rigid(world, 0);
  const auto energy = [&] { return 0.5 * bunny.angular_momentum.dot(bunny.angular_velocity()); };
  world.start();
  const Vec3 l0 = world.record().stats.angular_momentum, spin0 = bunny.angular_momentum;
  const double e0 = energy();
  run(world, 1000);
  CHECK((world.record().stats.angular_momentum - l0).norm() < 1e-12 * l0.norm());
  CHECK((bunny.angular_momentum - spin0).norm() == 0.0);
  CHECK(std::abs(energy() - e0) < 1e-11 * e0);
}

TEST_CASE("a body spun about its middle axis flips over and over, momentum and energy kept") {
  // inertia 1 : 2 : 3; the middle axis is unstable (Dzhanibekov), the others are stable
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    const Vec3 moments(1.0, 2.0, 3.0);
    RigidBody body = spinning(moments, Mat3::Identity(), 10.0 * Vec3::Unit(axis) + 1e-3 * Vec3::Ones());
    const Vec3 l0 = body.angular_momentum;
    const double e0 = energy(body, moments);
    double lowest = 1.0, worst_energy = 0.0;
    for (int i = 0; i < 1000; ++i) {
      advance_rigid(body, 0.01);
      worst_energy = std::max(worst_energy, std::abs(energy(body, moments) - e0) / e0);
      lowest = std::min(lowest, body.pose.rotation.col(axis).dot(l0.normalized()));
    }
    CHECK((body.angular_momentum - l0).norm() == 0.0);
    CHECK(worst_energy < 1e-12);
    if (axis == 1) CHECK(lowest < -0.9);   // it has turned over
    if (axis != 1) CHECK(lowest > 0.999);  // it has not
    CHECK((body.pose.rotation * body.pose.rotation.transpose() - Mat3::Identity()).norm() < 1e-13);
  }
}

TEST_CASE("free rotation keeps momentum and energy whatever the inertia and the turn of a step") {
  Random random(11);
  const double h = 1.0 / 240.0;
  for (const double ratio : {1.0, 3.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e8})
    for (const Inertia& inertia : inertias(ratio))
      for (const double turn : {1e-12, 1e-6, 1e-3, 0.1, 2.0, 20.0, 1e3})
        for (int kind = 0; kind < 3; ++kind) {
          // any spin; nearly about a principal axis, the middle one too; across the first, which may be the needle's
          Vec3 spin = random.direction();
          if (kind == 1) spin = Vec3::Unit(random.below(3)) + 1e-3 * random.direction();
          if (kind == 2) spin -= Vec3(spin.x(), 0.0, 0.0);
          Vec3 sorted = inertia.moments;
          std::sort(sorted.data(), sorted.data() + 3);
          if (turn * sorted[2] / sorted[1] > 1e8)
            continue;  // a disc so heavy (there is none) wobbles too fast to follow
          CAPTURE(inertia.name, ratio, turn, kind);
          RigidBody body = spinning(inertia.moments, random.rotation(), turn / h * spin.normalized());
          const Vec3 l0 = body.angular_momentum;
          const double e0 = energy(body, inertia.moments);
          double worst = 0.0;
          for (int i = 0; i < 1000; ++i) {
            advance_rigid(body, h);
            worst = std::max(worst, std::abs(energy(body, inertia.moments) - e0) / e0);
            if (!(worst < 1e-6)) break;
          }
          CHECK(worst < 1e-13 * std::sqrt(ratio) + 1e-11);
          CHECK((body.angular_momentum - l0).norm() == 0.0);
          CHECK((body.pose.rotation * body.pose.rotation.transpose() - Mat3::Identity()).norm() < 1e-14);
        }
}

TEST_CASE("a free body keeps its energy over ten thousand steps, and its attitude orthonormal over a million",
          "[long]") {
  const double h = 1.0 / 240.0;
  Random random(12);
  for (const double ratio : {1.0, 10.0, 1e3, 1e5})
    for (const Inertia& inertia : inertias(ratio))
      for (const double turn : {0.05, 2.0}) {
        CAPTURE(inertia.name, ratio, turn);
        RigidBody body = spinning(inertia.moments, random.rotation(), turn / h * random.direction());
        const Vec3 l0 = body.angular_momentum;
        const double e0 = energy(body, inertia.moments);
        double worst = 0.0;
        for (int i = 0; i < 1000000; ++i) {
          advance_rigid(body, h);
          if (i < 10000) worst = std::max(worst, std::abs(energy(body, inertia.moments) - e0) / e0);
        }
        CHECK(worst < 1e-10);
        CHECK((body.angular_momentum - l0).norm() == 0.0);
        CHECK((body.pose.rotation * body.pose.rotation.transpose() - Mat3::Identity()).norm() < 1e-14);
      }
}

TEST_CASE("free rotation follows the equations of motion, in one step or in many") {
  Random random(13);
  for (int i = 0; i < 120; ++i) {
    const double ratio = std::pow(10.0, random.in(0.0, 1.5)), turn = std::pow(10.0, random.in(-2.0, 1.0));
    const Vec3 moments = inertias(ratio)[i % 6].moments;
    Vec3 spin = random.direction();
    if (i % 5 == 0) spin = (Vec3::Unit(i % 3) + 0.05 * spin).normalized();
    const Mat3 rotation = random.rotation();
    RigidBody body = spinning(moments, rotation, turn * spin), slow = spinning(moments, rotation, turn * spin);
    CAPTURE(i, moments.transpose(), turn, spin.transpose());
    const Mat3 truth = by_small_steps(moments, body.pose.rotation, body.angular_momentum, 1.0);
    advance_rigid(body, 1.0);
    for (int k = 0; k < 64; ++k) advance_rigid(slow, 1.0 / 64.0);
    CHECK((body.pose.rotation - truth).norm() < 1e-11);
    CHECK((slow.pose.rotation - truth).norm() < 1e-11);
  }
}

TEST_CASE("a symmetric body precesses about its momentum as the closed form says") {
  // R(t) = exp(t L/I) R(0) exp(t (1/J - 1/I) l e), J about the body's own axis e, l the momentum along it
  Random random(14);
  for (const double ratio : {1.0 / 2.0, 0.999999999, 1.5, 10.0, 1e3, 1e5, 1e7})
    for (const double turn : {1e-3, 0.1, 2.0, 20.0})
      for (const int axis : {0, 1, 2}) {
        CAPTURE(ratio, turn, axis);
        Vec3 moments = Vec3::Constant(ratio);
        moments[axis] = 1.0;
        RigidBody body = spinning(moments, random.rotation(), turn * random.direction());
        const Mat3 start = body.pose.rotation;
        const double along = start.col(axis).dot(body.angular_momentum);
        for (int k = 1; k <= 1000; ++k) advance_rigid(body, 1.0);
        const Mat3 truth =
            Eigen::AngleAxisd(1000.0 * body.angular_momentum.norm() / ratio, body.angular_momentum.normalized()) *
            start * Eigen::AngleAxisd(1000.0 * (1.0 - 1.0 / ratio) * along, Vec3::Unit(axis));
        // an attitude of doubles holds the spin about a needle to 1e-16 of the whole momentum; each step rounds it anew,
        // and the angle sums up what has come together so far
        const double spin = 3e-15 * std::max(1.0, ratio) * turn * std::pow(1000.0, 1.5);
        CHECK((body.pose.rotation - truth).norm() < 1e-12 * (1.0 + 1000.0 * turn) + spin);
      }
}

TEST_CASE("a slender rod in free flight keeps its kinetic energy") {
  for (const SharedShape& shape : {SharedShape(Capsule(0.008, 0.6)), SharedShape(Box(Vec3(0.11, 0.004, 0.003)))}) {
    World world;
    world.parameters.simulation.gravity.setZero();
    world.parameters.simulation.frame_time = 1.0 / 240.0;
    world.parameters.simulation.substeps = 1;
    BodyDescription d = dynamic_body("rod", shape, Vec3(0, 1, 0));
    d.rotation = Vec3(0, 20, 90);
    d.angular_velocity = Vec3(3, 60, 5);
    world.add_body(d);
    world.start();
    const double start = world.record().stats.kinetic;
    double worst = 0.0;
    for (int i = 0; i < 240; ++i) {
      world.step();
      worst = std::max(worst, std::abs(world.record().stats.kinetic - start) / start);
    }
    CHECK(worst < 1e-11);
  }
}
