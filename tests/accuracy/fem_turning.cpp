// Deformable bodies that turn freely: what integrators make of the strain, the energy and the angular momentum of a body.
#include <catch2/catch.hpp>

#include "engine/integrators/turning_swell.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

constexpr double kStiff = 1e7, kNearlyRubber = 0.49, kCubeSide = 0.2;

/// A cube at rest in shape that turns about its z axis.
DeformableBody spinning_cube(double omega, double beta) {
  DeformableBody body = test::make_body(
      make_tet_box(Vec3::Constant(kCubeSide), 3, 3, 3),
      {.material = "corotational", .young = kStiff, .poisson = kNearlyRubber, .mass = MassKind::lumped});
  body.damping = {0.0, beta};
  const Vec3 center = body.center_of_mass();
  for (int i = 0; i < body.nodes(); ++i)
    body.velocity.segment<3>(3 * i) = Vec3(0, 0, omega).cross(Vec3(body.position.segment<3>(3 * i)) - center);
  return body;
}

void spin_on(const char* scheme, DeformableBody& body, double h, double time) {
  const auto integrator = find_entry(integrators(), scheme)->make();
  if (integrator->newton() != nullptr) configure(*integrator, std::vector<RowText>{{"tolerance", "1e-9"}});
  const auto solver = make_linear_solver("simplicial_llt");
  solver->analyze(*body.free_pattern());
  DeformableStep step;
  for (int i = 0; i < std::lround(time / h); ++i) advance_alone(*integrator, body, Vec3::Zero(), h, *solver, step);
}

/// A bar that tumbles and vibrates by a tenth of its size, of a material that knows what a turn is.
DeformableBody tumbling_bar(const char* material, ElementKind kind) {
  DeformableBody body =
      test::make_body(kind == ElementKind::linear ? make_tet_box(Vec3(0.4, 0.2, 0.1), 4, 2, 1)
                                                  : make_tet_box(Vec3(0.4, 0.2, 0.1), 2, 1, 1),
                      {.material = material, .young = 1e5, .poisson = 0.4, .mass = MassKind::lumped, .element = kind});
  const Vec3 center = body.center_of_mass();
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec3 arm = Vec3(body.position.segment<3>(3 * i)) - center;
    body.velocity.segment<3>(3 * i) =
        Vec3(3, 5, 4).cross(arm) + 0.5 * Vec3(10 * arm.x(), -10 * arm.y(), std::sin(20 * arm.x()));
  }
  return body;
}

}  // namespace

TEST_CASE("linearly implicit Euler swells what turns by ω² h (h + β)/2, and implicit Euler does not") {
  const double mu = kStiff / (2.0 * (1.0 + kNearlyRubber)),
               lambda = kStiff * kNearlyRubber / ((1.0 + kNearlyRubber) * (1.0 - 2.0 * kNearlyRubber));
  for (const double beta : {0.0, 0.005})
    for (const double h : {1.0 / 120.0, 1.0 / 480.0})
      for (const double omega : {2.0, 10.0}) {
        CAPTURE(beta, h, omega);
        const double strain = 0.5 * omega * omega * h * (h + beta);
        const double energy = 2.0 * (mu + lambda) * strain * strain * kCubeSide * kCubeSide * kCubeSide;
        DeformableBody body = spinning_cube(omega, beta);
        spin_on("linearly_implicit_euler", body, h, 1.0);
        CHECK(body.elastic_energy() == Approx(energy).epsilon(0.04));
        const auto told = turning_swell(body, h);
        REQUIRE(told);
        // it turns slower as it is larger
        CHECK(told->strain == Approx(strain).epsilon(0.03));
        CHECK(told->energy == Approx(body.elastic_energy()).epsilon(0.05));
        CHECK(told->turn == Approx(omega * h).epsilon(0.02));
        DeformableBody other = spinning_cube(omega, beta);
        spin_on("implicit_euler", other, h, 1.0);
        CHECK(other.elastic_energy() < 1e-3 * energy);
      }
}

TEST_CASE("damping of strains brakes no turning") {
  // what implicit Euler loses of the angular momentum is its own, (ω h)² a sub-step to begin with, and no more with damping
  for (const double omega : {2.0, 10.0})
    for (const double h : {1.0 / 120.0, 1.0 / 480.0}) {
      CAPTURE(omega, h);
      double left[2];
      for (const bool is_damped : {false, true}) {
        DeformableBody body = spinning_cube(omega, is_damped ? 0.005 : 0.0);
        const double before = body.angular_momentum().z();
        spin_on("implicit_euler", body, h, 1.0);
        left[is_damped ? 1 : 0] = body.angular_momentum().z() / before;
      }
      CHECK(left[1] > left[0]);
      CHECK(left[1] > 1.0 - omega * omega * h);
    }
}

TEST_CASE(
    "the energy-momentum scheme keeps energy and angular momentum of what tumbles and vibrates, of every material") {
  for (const char* material : {"corotational", "fixed_corotated", "neo_hookean", "stvk", "mass_spring"})
    for (const ElementKind kind : {ElementKind::linear, ElementKind::quadratic}) {
      CAPTURE(material, static_cast<int>(kind));
      DeformableBody body = tumbling_bar(material, kind);
      const double energy = body.kinetic_energy() + body.elastic_energy();
      const Vec3 spin = body.angular_momentum(), momentum = body.momentum();
      spin_on("energy_momentum", body, 1.0 / 240.0, 1.0);
      // to the tolerance of its iteration, 1e-9 a step
      CHECK(body.kinetic_energy() + body.elastic_energy() == Approx(energy).epsilon(1e-6));
      CHECK((body.angular_momentum() - spin).norm() < 1e-6 * spin.norm());
      CHECK((body.momentum() - momentum).norm() < 1e-6 * body.mass);
      CHECK(body.elastic_energy() > 1e-2 * energy);  // it still vibrates
    }
}

TEST_CASE("the energy-momentum scheme turns a stiff cube as it is, damped or not") {
  for (const double beta : {0.0, 0.005})
    for (const double omega : {2.0, 10.0}) {
      CAPTURE(beta, omega);
      DeformableBody body = spinning_cube(omega, beta);
      const double spin = body.angular_momentum().z(), energy = body.kinetic_energy();
      spin_on("energy_momentum", body, 1.0 / 120.0, 1.0);
      CHECK(body.angular_momentum().z() == Approx(spin).epsilon(1e-3));
      CHECK(body.kinetic_energy() == Approx(energy).epsilon(2e-3));
    }
}

TEST_CASE("newmark's damping brakes what turns by 4 β (μ + λ) V (ω h)² ω, and wins nothing") {
  const double beta = 0.005, mu = kStiff / (2.0 * (1.0 + kNearlyRubber)),
               lambda = kStiff * kNearlyRubber / ((1.0 + kNearlyRubber) * (1.0 - 2.0 * kNearlyRubber));
  for (const double omega : {1.0, 2.0, 10.0})
    for (const double h : {1.0 / 480.0, 1.0 / 960.0, 1.0 / 1920.0}) {
      CAPTURE(omega, h);
      DeformableBody body = spinning_cube(omega, beta);
      const double before = body.angular_momentum().z(), energy = body.kinetic_energy(), inertia = before / omega;
      const double rate = 4.0 * beta * (mu + lambda) * std::pow(kCubeSide, 3) * h * h / inertia;  // of dω/dt = −rate ω³
      spin_on("newmark", body, h, 1.0);
      const double left = 1.0 / std::sqrt(1.0 + 2.0 * rate * omega * omega);
      CHECK(body.angular_momentum().z() == Approx(left * before).epsilon(0.05));
      CHECK(body.kinetic_energy() < 1.001 * energy);
    }
}
