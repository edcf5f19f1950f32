#include "engine/bodies/element_stress.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

constexpr double kYoung = 2e5, kPoisson = 0.3;
constexpr double kMu = kYoung / (2.0 * (1.0 + kPoisson));
constexpr double kLambda = kYoung * kPoisson / ((1.0 + kPoisson) * (1.0 - 2.0 * kPoisson));

/// Two cells of one material, every node moved by x ↦ F x + t.
DeformableBody deformed(std::string_view material, const Mat3& f) {
  TetMesh mesh = make_tet_box(Vec3(0.2, 0.1, 0.1), 2, 1, 1);
  DeformableBody body = test::make_body(mesh, {.material = material, .young = kYoung, .poisson = kPoisson});
  for (int i = 0; i < body.nodes(); ++i) body.position.segment<3>(3 * i) = f * mesh.vertices[i] + Vec3(0.3, -5.0, 2.0);
  return body;
}

/// First Piola–Kirchhoff stress for F = diag(s), written out from each material's textbook form.
Vec3 textbook(std::string_view material, const Vec3& s) {
  const Vec3 small = s - Vec3::Ones(), green = 0.5 * (s.cwiseAbs2() - Vec3::Ones());
  const double j = s.prod();
  if (material == "stvk") return s.cwiseProduct(2.0 * kMu * green + Vec3::Constant(kLambda * green.sum()));
  if (material == "fixed_corotated") return 2.0 * kMu * small + kLambda * (j - 1.0) * j * s.cwiseInverse();
  if (material == "neo_hookean") return kMu * (s - s.cwiseInverse()) + kLambda * std::log(j) * s.cwiseInverse();
  return 2.0 * kMu * small + Vec3::Constant(kLambda * small.sum());  // linear, corotational
}

}  // namespace

TEST_CASE("stress under principal stretches is P F/J of each material's formula") {
  const Vec3 s(1.3, 0.9, 0.8);
  for (const auto& entry : materials()) {
    if (entry.name == "mass_spring") continue;
    CAPTURE(std::string(entry.name));
    const DeformableBody body = deformed(entry.name, s.asDiagonal());
    const Vec3 expected = textbook(entry.name, s).cwiseProduct(s) / s.prod();
    for (int e = 0; e < 12; ++e) {
      const ElementState state = element_state(body, e);
      CHECK((state.stress - Mat3(expected.asDiagonal())).norm() < 1e-10 * expected.norm());
      CHECK(state.volume_ratio == Approx(s.prod()).epsilon(1e-12));
      CHECK((state.stretch - s).norm() < 1e-12);
    }
  }
}

TEST_CASE("uniaxial tension and simple shear give the tension and √3 times the shear") {
  // σ = E ε along x with free sides; τ = μ γ
  const double strain = 1e-6;
  for (const auto& entry : materials()) {
    if (entry.name == "mass_spring") continue;
    CAPTURE(std::string(entry.name));
    const Vec3 pulled(1.0 + strain, 1.0 - kPoisson * strain, 1.0 - kPoisson * strain);
    CHECK(element_von_mises(deformed(entry.name, pulled.asDiagonal()))[3] == Approx(kYoung * strain).epsilon(1e-5));
    Mat3 sheared = Mat3::Identity();
    sheared(0, 1) = strain;
    CHECK(element_von_mises(deformed(entry.name, sheared))[3] == Approx(std::sqrt(3.0) * kMu * strain).epsilon(1e-5));
    CHECK(element_equivalent_strain(deformed(entry.name, sheared))[3] == Approx(strain / std::sqrt(3.0)).epsilon(1e-5));
  }
  CHECK(equivalent_strain(Vec3(1.02, 0.99, 0.99)) == Approx(0.02).epsilon(1e-12));
  CHECK(equivalent_strain(Vec3(1.1, 1.1, 1.1)) == Approx(0.0).margin(1e-15));
  // finite simple shear of the neo-Hookean: σ_12 = μ γ, σ_11 = μ γ², others 0
  Mat3 f = Mat3::Identity();
  f(0, 1) = 0.7;
  const Mat3 stress = element_state(deformed("neo_hookean", f), 5).stress;
  Mat3 expected = Mat3::Zero();
  expected(0, 1) = expected(1, 0) = 0.7 * kMu;
  expected(0, 0) = 0.49 * kMu;
  CHECK((stress - expected).norm() < 1e-10 * expected.norm());
}

TEST_CASE("a rotation has no stress and turns it, except with linear elasticity") {
  test::Random random(81);
  for (const auto& entry : materials()) {
    CAPTURE(std::string(entry.name));
    const Mat3 r = random.rotation(), f = test::stretched(random, Vec3(1.2, 1.0, 0.7));
    const auto turned = element_von_mises(deformed(entry.name, r));
    if (entry.name == "linear") {
      CHECK(*std::max_element(turned.begin(), turned.end()) > 0.01 * kYoung);
      continue;
    }
    for (const double s : turned) CHECK(s < 1e-9 * kYoung);
    for (const double s : element_equivalent_strain(deformed(entry.name, r))) CHECK(s < 1e-12);
    const DeformableBody before = deformed(entry.name, f), after = deformed(entry.name, r * f);
    for (int e = 0; e < 12; ++e) {
      const Mat3 expected = r * element_state(before, e).stress * r.transpose();
      CHECK((element_state(after, e).stress - expected).norm() < 1e-9 * expected.norm());
    }
  }
}

TEST_CASE("stress is the work of straining further, for springs too, and for inverted elements") {
  // E(x ↦ (1 + t D) x) has the slope V |J| σ : D at t = 0 for symmetric D
  test::Random random(82);
  for (const auto& entry : materials())
    for (const Vec3& s : {Vec3(1.2, 1.0, 0.7), Vec3(1.1, 0.8, -0.5)}) {
      CAPTURE(std::string(entry.name), s.transpose());
      const Mat3 f = test::stretched(random, s);
      Mat3 d;
      for (int k = 0; k < 9; ++k) d(k % 3, k / 3) = random.sym();
      d = 0.5 * (d + d.transpose()).eval();
      const double t = 1e-5;
      const DeformableBody now = deformed(entry.name, f), more = deformed(entry.name, (Mat3::Identity() + t * d) * f),
                           less = deformed(entry.name, (Mat3::Identity() - t * d) * f);
      for (int e = 0; e < 12; ++e) {
        const auto energy = [&](const DeformableBody& body) {
          Corners x;
          for (int k = 0; k < 4; ++k) x.col(k) = body.position.segment<3>(3 * body.fem.rest().tets[e][k]);
          return body.fem.material(e).energy(body.fem.elements()[e], x);
        };
        const ElementState state = element_state(now, e);
        const double power =
            now.fem.elements()[e].volume * std::abs(state.volume_ratio) * state.stress.cwiseProduct(d).sum();
        CHECK((energy(more) - energy(less)) / (2.0 * t) ==
              Approx(power).epsilon(1e-5).margin(1e-6 * kYoung * now.fem.elements()[e].volume));
      }
    }
}

TEST_CASE("flat elements have a finite stress, and nodes get the mean of what surrounds them") {
  for (const auto& entry : materials()) {
    const DeformableBody flat = deformed(entry.name, Vec3(1.0, 1.0, 0.0).asDiagonal());
    for (const double s : element_von_mises(flat)) CHECK(std::isfinite(s));
    for (const double j : element_volume_ratio(flat)) CHECK(std::abs(j) < 1e-12);
  }
  const DeformableBody body = deformed("corotational", Mat3::Identity());
  std::vector<double> first(12, 0.0);
  for (int e = 0; e < 6; ++e) first[e] = 2.0;  // one cell 2, the other 0
  const std::vector<double> mean = node_average(body, first);
  double weighted = 0.0;
  for (int i = 0; i < body.nodes(); ++i) {
    weighted += mean[i] * body.fem.node_mass()[i] / body.fem.total_mass();
    const double x = body.fem.rest().vertices[i].x();
    if (x < 0.05) CHECK(mean[i] == Approx(2.0));
    if (x > 0.15) CHECK(mean[i] == Approx(0.0).margin(1e-15));
  }
  CHECK(weighted == Approx(1.0));
}
