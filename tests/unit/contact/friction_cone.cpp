#include <catch2/catch.hpp>

#include "engine/contact/friction_cone.hpp"
#include "engine/lcp/residual.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("the cone projection is the nearest point of the cone") {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double mu = random.in(0.0, 2.0);
    const Vec3 z = random.vector() * 3.0;
    const Vec3 p = project_to_cone(z, mu);
    CHECK(std::hypot(p.y(), p.z()) <= mu * p.x() + 1e-12);
    // variational characterisation: (z - p)·(k - p) <= 0 for every k of the cone
    for (int k = 0; k < 20; ++k) {
      const double n = random.in(0.0, 3.0), angle = random.in(0.0, 2 * M_PI), t = mu * n * random.u();
      const Vec3 point(n, t * std::cos(angle), t * std::sin(angle));
      CHECK((z - p).dot(point - p) <= 1e-12);
    }
    const Vec3 d = project_to_dual_cone(z, mu);
    CHECK((d - z).dot(d) == Approx(0.0).margin(1e-12));
    CHECK(d.x() >= mu * std::hypot(d.y(), d.z()) - 1e-12);
  }
}

TEST_CASE("the pyramid's projection is its nearest point, and the shift makes box friction a complementarity") {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const double mu = random.in(0.0, 2.0);
    const Vec3 z = random.vector() * 3.0;
    const Vec3 p = project_to_pyramid(z, mu);
    CHECK(cone_violation(p, mu, FrictionLaw::pyramid) <= 1e-12);
    for (int k = 0; k < 20; ++k) {
      const double n = random.in(0.0, 3.0);
      const Vec3 point(n, mu * n * random.sym(), mu * n * random.sym());
      CHECK((z - p).dot(point - p) <= 1e-12);
    }
    // sliding: each tangent at its bound against its velocity, u_n = 0; sticking: u = 0; open: u_n >= 0
    const double n = random.in(0.1, 2.0);
    const Vec3 u(0.0, random.sym(), random.sym()), slip(n, u.y() > 0 ? -mu * n : mu * n, u.z() > 0 ? -mu * n : mu * n);
    CHECK(natural_map(Mat3::Identity(), u, slip, mu, FrictionLaw::pyramid) == Approx(0.0).margin(1e-13));
    CHECK(natural_map(Mat3::Identity(), Vec3::Zero(), p, mu, FrictionLaw::pyramid) == Approx(0.0).margin(1e-13));
    CHECK(natural_map(Mat3::Identity(), Vec3(random.u(), u.y(), u.z()), Vec3::Zero(), mu, FrictionLaw::pyramid) ==
          Approx(0.0).margin(1e-13));
    if (mu > 0.01)
      CHECK(natural_map(Mat3::Identity(), u, Vec3(n, -slip.y(), slip.z()), mu, FrictionLaw::pyramid) >
            1e-4 * std::abs(u.y()) * mu * n);
  }
}

TEST_CASE("one contact is solved exactly: take-off, stick and slip") {
  Random random(2);
  int open = 0, stick = 0, slip = 0;
  for (int i = 0; i < 5000; ++i) {
    // W from a random body: I/m plus a lever arm's part, so normal and tangents couple
    Mat3 w = random.in(0.1, 2.0) * Mat3::Identity();
    for (int k = 0; k < 2; ++k) {
      const Vec3 a = random.vector() * 2.0;
      w += a * a.transpose();
    }
    const double mu = i % 10 == 0 ? 0.0 : random.in(0.01, 1.5);
    const Vec3 b = random.vector() * std::pow(10.0, random.in(-6, 3));
    const Vec3 lambda = solve_one_contact(w, b, mu);
    Vec3 u = w * lambda + b;
    CAPTURE(i, mu, b.transpose(), lambda.transpose(), u.transpose());
    REQUIRE(lambda.allFinite());
    // Coulomb's law itself, written out
    CHECK(lambda.x() >= 0.0);
    CHECK(std::hypot(lambda.y(), lambda.z()) <= mu * lambda.x() * (1 + 1e-12));
    const double scale = b.norm();
    CHECK(u.x() >= -1e-10 * scale);
    CHECK(std::abs(lambda.x() * u.x()) <= 1e-10 * scale * lambda.norm() + 1e-300);
    const Vec2 ut = u.tail<2>(), lt = lambda.tail<2>();
    if (lambda.x() == 0.0) {
      ++open;
    } else if (mu > 0.0 && ut.norm() <= 1e-9 * scale) {
      ++stick;
    } else if (mu > 0.0) {
      ++slip;
      CHECK(lt.norm() == Approx(mu * lambda.x()).epsilon(1e-9));
      CHECK((lt / lt.norm() + ut / ut.norm()).norm() < 1e-6);  // against the sliding
    }
    if (mu > 0.0) CHECK(natural_map(w, u, lambda, mu) <= 1e-9 * scale);
  }
  CHECK(open > 100);
  CHECK(stick > 100);
  CHECK(slip > 100);
}
