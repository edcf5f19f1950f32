// What every registered material must fulfil, checked against differences of its energy and against rotations.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "engine/materials/isotropic.hpp"
#include "tests/support/mechanics/elements.hpp"

using namespace impinge;
using test::Element;

namespace {

// Fourth-order central difference: error h⁴ of the fifth derivative; h is 1e-3 of the element, so truncation and
// rounding both stay below 1e-9 of the largest entry.
template <class Value, class Function>
Value difference(const Function& f, double h) {
  const Value near = f(h) - f(-h), far = f(2.0 * h) - f(-2.0 * h);
  return (8.0 * near - far) / (12.0 * h);
}

Eigen::Matrix<double, 12, 1> flat(const Corners& c) { return Eigen::Map<const Eigen::Matrix<double, 12, 1>>(c.data()); }

void check_derivatives(const Material& material, const Element& element, const Corners& x, double h) {
  ElementResponse out;
  material.response(element.rest, x, Tangent::exact, out);
  CHECK(out.energy == Approx(material.energy(element.rest, x)).epsilon(1e-12).margin(1e-14));
  Eigen::Matrix<double, 12, 1> force;
  Mat12 stiffness;
  for (int i = 0; i < 12; ++i) {
    const auto moved = [&](double t) {
      Corners y = x;
      y(i % 3, i / 3) += t;
      return y;
    };
    force[i] = -difference<double>([&](double t) { return material.energy(element.rest, moved(t)); }, h);
    stiffness.col(i) = -difference<Eigen::Matrix<double, 12, 1>>(
        [&](double t) {
          ElementResponse r;
          material.force(element.rest, moved(t), r);
          return flat(r.force);
        },
        h);
  }
  const double force_scale = std::max(flat(out.force).norm(), 1e-3 * stiffness.norm() * std::cbrt(element.rest.volume));
  CHECK((flat(out.force) - force).norm() < 1e-6 * force_scale);
  CHECK((full_stiffness(out) - stiffness).norm() < 1e-6 * stiffness.norm());
}

}  // namespace

TEST_CASE("force and exact tangent are the derivatives of the energy, for moderate and strong deformation",
          "[methods]") {
  for (const auto& entry : materials())
    for (const double poisson : {0.1, 0.3, 0.49}) {
      test::Random random(21);
      const auto material = test::make_material(entry.name, 1e5, poisson);
      CAPTURE(std::string(entry.name), poisson);
      for (int i = 0; i < 10; ++i) {
        const Element e = test::random_element(random);
        check_derivatives(
            *material, e,
            e.deformed(test::stretched(random, Vec3(random.in(1.2, 1.6), random.in(0.9, 1.1), random.in(0.5, 0.8)))),
            1e-5);
        check_derivatives(
            *material, e,
            e.deformed(test::stretched(random, Vec3(random.in(2, 5), random.in(0.5, 1.5), random.in(0.2, 0.4)))), 1e-5);
      }
    }
}

TEST_CASE("derivatives at equal stretches, at rest and under rotation", "[methods]") {
  for (const auto& entry : materials()) {
    test::Random random(22);
    const auto material = test::make_material(entry.name);
    CAPTURE(std::string(entry.name));
    const Element e = test::random_element(random);
    for (const Vec3& s : {Vec3(1, 1, 1), Vec3(1.3, 1.3, 0.8), Vec3(0.7, 0.7, 0.7), Vec3(2, 0.6, 0.6)})
      check_derivatives(*material, e, e.deformed(test::stretched(random, s)), 1e-5);
  }
}

TEST_CASE("derivatives of inverted elements", "[methods]") {
  // stvk knows σ² only and linear knows no inversion; those whose energy tells the sign apart have a kink where two
  // stretches of opposite sign are equal in size, so the stretches here stay away from that
  for (const auto& entry : materials()) {
    test::Random random(23);
    const auto material = test::make_material(entry.name);
    CAPTURE(std::string(entry.name));
    for (int i = 0; i < 10; ++i) {
      const Element e = test::random_element(random);
      check_derivatives(
          *material, e,
          e.deformed(test::stretched(random, Vec3(random.in(1.5, 2), random.in(0.8, 1.2), -random.in(0.05, 0.5)))),
          1e-6);
      check_derivatives(
          *material, e,
          e.deformed(test::stretched(random, Vec3(random.in(0.9, 1.1), random.in(0.3, 0.6), -random.in(0.01, 0.2)))),
          1e-6);
    }
  }
}

TEST_CASE("neo_hookean: derivatives below, across and above its extension threshold") {
  test::Random random(24);
  for (const double threshold : {0.1, 0.6}) {
    const auto material = test::make_material("neo_hookean", 1e5, 0.45);
    configure(*material, std::vector<RowText>{{"extension_threshold", shortest(threshold)}});
    for (int i = 0; i < 20; ++i) {
      const Element e = test::random_element(random);
      const double a = random.in(0.2, 3.0) * threshold, b = random.in(0.2, 3.0) * threshold;
      const Vec3 s(std::max({a, b, 1.0}), std::max(a, b), std::min(a, b));
      if ((s.array() / threshold - 1.0).abs().minCoeff() < 0.02)
        continue;  // the third derivative jumps there: differences see it
      check_derivatives(*material, e, e.deformed(test::stretched(random, s)), 1e-6);
    }
  }
}

TEST_CASE("neo_hookean is twice differentiable at its threshold and matches the logarithm above it") {
  const auto material = test::make_material("neo_hookean");
  const auto& isotropic = dynamic_cast<const IsotropicMaterial&>(*material);
  const double mu = material->settings().mu(), lambda = material->settings().lambda();
  const Vec3 s(1.4, 0.9, 0.3);
  const double log_j = std::log(s.prod());
  CHECK(isotropic.density(isotropic.lame(), s) ==
        Approx(0.5 * mu * (s.squaredNorm() - 3.0) - mu * log_j + 0.5 * lambda * log_j * log_j).epsilon(1e-14));
  const Vec3 below(1.4, 0.9, 0.1 - 1e-9), above(1.4, 0.9, 0.1 + 1e-9);
  CHECK(isotropic.density(isotropic.lame(), below) == Approx(isotropic.density(isotropic.lame(), above)).epsilon(1e-6));
  CHECK((isotropic.density_gradient(isotropic.lame(), below) - isotropic.density_gradient(isotropic.lame(), above))
            .norm() < 1e-6 * isotropic.density_gradient(isotropic.lame(), above).norm());
  CHECK((isotropic.density_hessian(isotropic.lame(), below).principal -
         isotropic.density_hessian(isotropic.lame(), above).principal)
            .norm() < 1e-6 * isotropic.density_hessian(isotropic.lame(), above).principal.norm());
}

TEST_CASE("the energy of every isotropic material is that of Hooke's law in a small strain, to the strain's own size") {
  const Vec3 direction = Vec3(0.6, -0.3, 0.7);
  for (const auto& entry : materials()) {
    const auto material = test::make_material(entry.name, 1e5, 0.4);
    const auto* isotropic = dynamic_cast<const IsotropicMaterial*>(material.get());
    if (isotropic == nullptr) continue;
    CAPTURE(std::string(entry.name));
    const double mu = material->settings().mu(), lambda = material->settings().lambda();
    for (const double size : {1e-3, 1e-5, 1e-7}) {
      const Vec3 stretch = Vec3::Ones() + size * direction, strain = stretch - Vec3::Ones();
      const double hooke = mu * strain.squaredNorm() + 0.5 * lambda * strain.sum() * strain.sum();
      CHECK(isotropic->density(isotropic->lame(), stretch) == Approx(hooke).epsilon(3.0 * size + 1e-7));
    }
  }
}

TEST_CASE("warped and projected tangents are positive semidefinite", "[methods]") {
  for (const auto& entry : materials()) {
    test::Random random(25);
    const auto material = test::make_material(entry.name, 1e5, 0.45);
    CAPTURE(std::string(entry.name));
    for (int i = 0; i < 200; ++i) {
      const Element e = test::random_element(random);
      Mat3 f;
      for (int k = 0; k < 9; ++k) f(k % 3, k / 3) = 1.5 * random.sym();
      if (i % 4 == 0) f = test::stretched(random, Vec3(random.u(), 0.0, 0.0));
      if (i % 4 == 1) f = test::stretched(random, Vec3(1, random.u(), -random.u()));
      for (const Tangent tangent : {Tangent::automatic, Tangent::projected}) {
        ElementResponse out;
        material->response(e.rest, e.deformed(f), tangent, out);
        const Mat12 k = full_stiffness(out);
        REQUIRE(k.allFinite());
        const auto values = Eigen::SelfAdjointEigenSolver<Mat12>(k, Eigen::EigenvaluesOnly).eigenvalues();
        CHECK(values[0] >= -1e-12 * values.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST_CASE("the projected tangent is the exact one with its negative eigenvalues at zero", "[methods]") {
  for (const auto& entry : materials()) {
    const auto material = test::make_material(entry.name);
    const auto* isotropic = dynamic_cast<const IsotropicMaterial*>(material.get());
    if (isotropic == nullptr) continue;
    CAPTURE(std::string(entry.name));
    test::Random random(26);
    for (int i = 0; i < 100; ++i) {
      const Vec3 s(random.in(0.9, 2), random.in(0.4, 0.8), random.in(-0.3, 0.3));
      const Mat3 f = i % 10 == 0 ? test::stretched(random, Vec3(0.8, 0.8, 0.3)) : test::stretched(random, s);
      const auto exact = isotropic->stress_derivative(f, Tangent::exact),
                 projected = isotropic->stress_derivative(f, Tangent::projected);
      CHECK((exact - exact.transpose()).norm() < 1e-12 * exact.norm());
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(0.5 * (exact + exact.transpose()));
      const Eigen::Matrix<double, 9, 9> expected =
          eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
      CHECK((projected - expected).norm() < 1e-10 * exact.norm());
    }
  }
}

TEST_CASE("a rotation costs nothing, except with linear elasticity", "[methods]") {
  for (const auto& entry : materials()) {
    test::Random random(27);
    const auto material = test::make_material(entry.name);
    CAPTURE(std::string(entry.name));
    double worst = 0.0;
    for (int i = 0; i < 100; ++i) {
      const Element e = test::random_element(random);
      ElementResponse out;
      material->force(e.rest, e.deformed(random.rotation()), out);
      const double scale = material->settings().young * std::pow(e.rest.volume, 2.0 / 3.0);
      worst = std::max(worst, out.force.norm() / scale);
    }
    if (entry.name == "linear")
      CHECK(worst > 0.1);
    else
      CHECK(worst < 1e-10);
  }
}

TEST_CASE("six rigid motions are in the kernel of the tangent at rest", "[methods]") {
  for (const auto& entry : materials()) {
    test::Random random(28);
    const auto material = test::make_material(entry.name);
    const Element e = test::random_element(random);
    for (const Tangent tangent : {Tangent::automatic, Tangent::exact, Tangent::projected}) {
      ElementResponse out;
      material->response(e.rest, e.corners, tangent, out);
      const Mat12 k = full_stiffness(out);
      for (int i = 0; i < 6; ++i) {
        Corners motion;
        for (int a = 0; a < 4; ++a)
          motion.col(a) = i < 3 ? Vec3(Vec3::Unit(i)) : Vec3(Vec3::Unit(i - 3).cross(Vec3(e.corners.col(a))));
        CHECK((k * flat(motion)).norm() < 1e-10 * k.norm() * flat(motion).norm());
      }
    }
  }
}

TEST_CASE("all materials but springs agree with Hooke's law for small strains", "[methods]") {
  test::Random random(29);
  for (const auto& entry : materials()) {
    if (entry.name == "mass_spring") continue;
    const auto material = test::make_material(entry.name, 2e5, 0.3), hooke = test::make_material("linear", 2e5, 0.3);
    const Element e = test::random_element(random);
    ElementResponse a, b;
    material->response(e.rest, e.corners, Tangent::exact, a);
    hooke->response(e.rest, e.corners, Tangent::exact, b);
    CHECK((full_stiffness(a) - full_stiffness(b)).norm() < 1e-10 * full_stiffness(b).norm());
  }
}

TEST_CASE("springs along all directions have the documented moduli") {
  // mean of many random tetrahedra, each turned at random: the spread of edges becomes even. Uniaxial and pure volume
  // strain
  for (const double poisson : {0.25, 0.4}) {
    const auto springs = test::make_material("mass_spring", 1e5, poisson),
               hooke = test::make_material("linear", 1e5, poisson);
    test::Random random(30);
    for (const Vec3& strain : {Vec3(1e-4, 0, 0), Vec3(1e-4, 1e-4, 1e-4), Vec3(1e-4, -1e-4, 0)}) {
      double a = 0.0, b = 0.0;
      for (int i = 0; i < 20000; ++i) {
        const Element e = test::random_element(random);
        // turning the strain instead of the element
        const Mat3 r = random.rotation();
        const Mat3 f = Mat3::Identity() + r * strain.asDiagonal() * r.transpose();
        a += springs->energy(e.rest, e.deformed(f)) / e.rest.volume;
        b += hooke->energy(e.rest, e.deformed(f)) / e.rest.volume;
      }
      CHECK(a == Approx(b).epsilon(0.02));
    }
  }
}
