// Stiffness-proportional damping against what any force between a body's own parts obeys: none of it in a motion as a rigid
// body, no momentum and no angular momentum from it, however the body is strained and turned; and unstressed it is β K v.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

constexpr double kBeta = 0.02;

TetMesh shaken_box() {
  const Vec3 size(1.0, 0.7, 0.8);
  TetMesh mesh = make_tet_box(size, 2, 2, 2);
  test::shake_inside(mesh, size, 0.05, 61);
  return mesh;
}

VecX random_of(Eigen::Index size, std::uint64_t seed) {
  test::Random random(seed);
  VecX x(size);
  for (Eigen::Index i = 0; i < size; ++i) x[i] = random.sym();
  return x;
}

Vec3 node_at(const VecX& x, int node) { return x.segment<3>(3 * node); }

/// a + ω × x.
VecX rigid_velocity(const VecX& x, const Vec3& drift, const Vec3& spin) {
  VecX v(x.size());
  for (int i = 0; 3 * i < x.size(); ++i) v.segment<3>(3 * i) = drift + spin.cross(node_at(x, i));
  return v;
}

DeformableBody turned_body(const std::string& material, ElementKind element, double strain) {
  DeformableBody body = test::make_body(shaken_box(), {.material = material, .element = element});
  const Mat3 turn = rotation_exp(Vec3(0.7, -1.1, 0.4));
  const Vec3 away(3.0, -2.0, 5.0);
  const VecX off = strain * random_of(body.position.size(), 62);
  for (int i = 0; i < body.nodes(); ++i)
    body.position.segment<3>(3 * i) = away + turn * (node_at(body.position, i) + node_at(off, i));
  body.velocity = random_of(body.position.size(), 63);
  body.damping.beta = kBeta;
  return body;
}

}  // namespace

TEST_CASE("damping of strain rates has no force in a rigid motion, and no momentum and no torque, under any scheme") {
  const auto element = GENERATE(ElementKind::linear, ElementKind::quadratic);
  for (const auto& material : materials()) {
    if (!material.make()->is_objective()) continue;
    for (const auto& scheme : integrators())
      for (const double strain : {0.0, 0.03, 0.2}) {
        CAPTURE(std::string(material.name), std::string(scheme.name), strain, element == ElementKind::quadratic);
        DeformableBody body = turned_body(std::string(material.name), element, strain);
        const auto integrator = scheme.make();
        DeformableStep step;
        integrator->begin(body, Vec3::Zero(), 1e-3, step);
        const VecX& x = step.start;
        const VecX v = random_of(x.size(), 64), w = rigid_velocity(x, Vec3(0.3, 1.2, -0.7), Vec3(2.0, -1.0, 3.0));
        const VecX f = damping_force(body, step, v);
        double size = 0.0;
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (int i = 0; i < body.nodes(); ++i) {
          force += node_at(f, i);
          torque += node_at(x, i).cross(node_at(f, i));
          size += node_at(f, i).norm() * node_at(x, i).norm();
        }
        CHECK(size > 0.0);
        CHECK(force.norm() < 1e-12 * size);
        CHECK(torque.norm() < 1e-12 * size);
        CHECK((damping_force(body, step, v + w) - f).norm() < 1e-11 * f.norm());
        // what it takes is never given, for any two velocities alike
        const VecX other = random_of(x.size(), 65), zero = VecX::Zero(x.size());
        const VecX of_v = f - damping_force(body, step, zero),
                   of_other = damping_force(body, step, other) - damping_force(body, step, zero);
        CHECK(v.dot(of_v) > 0.0);
        CHECK(v.dot(of_other) == Approx(other.dot(of_v)).epsilon(1e-9).margin(1e-10 * of_v.norm() * other.norm()));
      }
  }
}

TEST_CASE(
    "damping of what is unstrained is β K v of its rest, turned with it, of linear elasticity β K v at any time") {
  const auto element = GENERATE(ElementKind::linear, ElementKind::quadratic);
  for (const auto& material : materials()) {
    CAPTURE(std::string(material.name), element == ElementKind::quadratic);
    const bool turns = material.make()->is_objective();
    DeformableBody body = turned_body(std::string(material.name), element, turns ? 0.0 : 0.2);
    DeformableBody rest = test::make_body(shaken_box(), {.material = material.name, .element = element});
    const Mat3 turn = turns ? rotation_exp(Vec3(0.7, -1.1, 0.4)) : Mat3::Identity();
    BlockMatrix k(rest.fem.pattern());
    VecX unused;
    rest.fem.stiffness(rest.position, Tangent::exact, unused, k);
    const VecX v = random_of(body.position.size(), 66);
    VecX back(v.size());
    for (int i = 0; i < body.nodes(); ++i) back.segment<3>(3 * i) = turn.transpose() * node_at(v, i);
    VecX truth = kBeta * (k * back);
    for (int i = 0; i < body.nodes(); ++i) truth.segment<3>(3 * i) = Vec3(turn * node_at(truth, i));
    const auto integrator = make_named(integrators(), "linearly_implicit_euler");
    DeformableStep step;
    integrator->begin(body, Vec3::Zero(), 1e-3, step);
    CHECK((damping_force(body, step, v) - truth).norm() < 1e-10 * truth.norm());
  }
}
