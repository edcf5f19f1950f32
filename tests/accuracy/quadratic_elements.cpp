// Quadratic tetrahedra alone: what linear ones lock at, patch test, derivatives, vibration, momentum, mass.
#include <catch2/catch.hpp>

#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

constexpr auto kQuadratic = ElementKind::quadratic;

/// 1 × 0.2 × 0.1 m, E 5e7, ρ 800, held at x = 0, under its weight along y, `cells` along it.
DeformableBody cantilever(ElementKind element, int cells, double poisson, std::string_view material = "linear",
                          MassKind mass = MassKind::lumped) {
  DeformableBody body = test::make_body(
      make_alternating_box(Vec3(1.0, 0.2, 0.1), cells, cells / 5, cells / 10),
      {.material = material, .young = 5e7, .poisson = poisson, .density = 800.0, .mass = mass, .element = element});
  body.hold(test::nodes_where(body, [](const Vec3& p) { return p.x() < 1e-9; }));
  return body;
}

double tip_deflection(DeformableBody& body) {
  test::solve_static(body, applied_force(body, Vec3(0, -9.81, 0)), "simplicial_llt", 30, 1e-9);
  double sum = 0.0;
  const std::vector<int> tip = test::nodes_where(body, [](const Vec3& p) { return p.x() > 1.0 - 1e-9; });
  for (const int i : tip) sum += body.fem.rest().vertices[i].y() - body.position[3 * i + 1];
  return sum / static_cast<double>(tip.size());
}

// where an independent program (quadratic tetrahedra with and without reduced λ, 10, 20, 40 cells, extrapolated) comes
// to, m: the two agree to 0.1 %. Timoshenko's beam, 6.126 mm at ν 0.3, knows nothing of a held section
struct Tip {
  double poisson, deflection;
};
constexpr Tip kTips[] = {{0.3, 6.062e-3}, {0.45, 5.993e-3}, {0.49, 5.965e-3}, {0.499, 5.958e-3}};
constexpr double kTimoshenko = 6.126e-3;

TetMesh irregular() {
  const Vec3 size(1.0, 0.7, 0.8);
  TetMesh mesh = make_tet_box(size, 3, 2, 3);
  test::shake_inside(mesh, size, 0.05, 71);
  return mesh;
}

VecX deformed(const DeformableBody& body, std::uint64_t seed, double amount) {
  test::Random random(seed);
  VecX x = body.position;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += amount * random.sym();
  return x;
}

}  // namespace

TEST_CASE("quadratic elements: a cantilever of 20 cells is right to 1 %, linear ones are 12.7 to 30 % too stiff") {
  for (const Tip& truth : kTips) {
    DeformableBody linear = cantilever(ElementKind::linear, 20, truth.poisson),
                   quadratic = cantilever(kQuadratic, 20, truth.poisson);
    const double l = tip_deflection(linear) / truth.deflection - 1.0,
                 q = tip_deflection(quadratic) / truth.deflection - 1.0;
    CAPTURE(truth.poisson, l, q);
    CHECK(l < -0.11);
    CHECK(std::abs(q) < 0.01);
    if (truth.poisson == 0.3) CHECK(std::abs(tip_deflection(quadratic) / kTimoshenko - 1.0) < 0.01);
  }
}

TEST_CASE("quadratic elements: as many unknowns as 20 linear cells have come to 2 %") {
  for (const Tip& truth : kTips) {
    DeformableBody body = cantilever(kQuadratic, 10, truth.poisson);
    CAPTURE(truth.poisson);
    CHECK(std::abs(tip_deflection(body) / truth.deflection - 1.0) < 0.02);
  }
}

TEST_CASE("quadratic elements: every law's small strains are the linear one's") {
  // a hundredth of the weight, so that the turn of the sections doesn't count
  for (const char* material : {"corotational", "fixed_corotated", "stvk", "neo_hookean"}) {
    DeformableBody body = cantilever(kQuadratic, 10, 0.49, material), linear = cantilever(kQuadratic, 10, 0.49);
    CAPTURE(std::string(material));
    for (DeformableBody* b : {&body, &linear})
      test::solve_static(*b, applied_force(*b, Vec3(0, -0.0981, 0)), "simplicial_llt", 30, 1e-10);
    CHECK(body.position.tail<3>().y() - 0.2 == Approx(linear.position.tail<3>().y() - 0.2).epsilon(2e-3));
  }
}

TEST_CASE("quadratic elements: the first bending frequency of 20 cells is a slender beam's to 1 %") {
  // Euler–Bernoulli's 8.077 Hz less 1.7 % for shear and rotary inertia at h/L = 0.2 (Timoshenko's beam, its frequency
  // equation solved for κ = 10 (1 + ν)/(12 + 11 ν)): 7.94 Hz
  for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
    DeformableBody body = cantilever(kQuadratic, 20, 0.3, "linear", mass);
    // the lowest mode is across the thin side
    const double thin = test::lowest_mode(body).omega / (2.0 * M_PI);
    CHECK(thin == Approx(4.0385 * 0.9965).epsilon(0.01));
  }
}

TEST_CASE("quadratic elements: a linear displacement of the boundary is reproduced inside, to rounding") {
  const Vec3 size(1.0, 0.8, 1.2);
  TetMesh mesh = make_tet_box(size, 3, 3, 4);
  test::shake_inside(mesh, size, 0.07, 61);
  test::Random random(62);
  for (const auto& entry : materials()) {
    if (entry.name == "mass_spring") continue;  // springs have no such test on irregular meshes
    for (const double poisson : {0.35, 0.49}) {
      CAPTURE(std::string(entry.name), poisson);
      DeformableBody body = test::make_body(mesh, {.material = entry.name, .poisson = poisson, .element = kQuadratic});
      body.hold(test::nodes_where(
          body, [&](const Vec3& p) { return (p.array() < 1e-9).any() || ((size - p).array() < 1e-9).any(); }));
      // a tenth of a change of volume is a pressure of five shear moduli at 0.49, and more than these elements bear
      Mat3 gradient;
      for (int k = 0; k < 9; ++k) gradient(k % 3, k / 3) = (poisson > 0.4 ? 0.01 : 0.1) * random.sym();
      const auto moved = [&](const Vec3& p) { return Vec3(p + gradient * p + Vec3(0.1, -0.2, 0.3)); };
      for (int i = 0; i < body.nodes(); ++i)
        body.position.segment<3>(3 * i) = moved(body.fem.rest().vertices[i]) +
                                          (body.is_held(i) ? Vec3::Zero().eval() : Vec3(0.002 * random.vector()));
      // the projected tangent is not the exact one where there is stress: its convergence is linear
      test::solve_static(body, VecX::Zero(3 * body.nodes()), "simplicial_llt", 400, 1e-14);
      double worst = 0.0;
      for (int i = 0; i < body.nodes(); ++i)
        worst = std::max(worst, (Vec3(body.position.segment<3>(3 * i)) - moved(body.fem.rest().vertices[i])).norm());
      CHECK(worst < 1e-12);
    }
  }
}

TEST_CASE("quadratic elements: force is the slope of the energy, the exact tangent that of the force") {
  for (const auto& entry : materials()) {
    CAPTURE(std::string(entry.name));
    DeformableBody body = test::make_body(irregular(), {.material = entry.name, .element = kQuadratic});
    const VecX x = deformed(body, 72, 0.01), way = deformed(body, 73, 1.0) - body.position;
    VecX f, f_plus, f_minus;
    BlockMatrix k(body.fem.pattern());
    body.fem.stiffness(x, Tangent::exact, f, k);
    constexpr double kStep = 1e-6;
    const double slope = (body.fem.energy(x + kStep * way) - body.fem.energy(x - kStep * way)) / (2.0 * kStep);
    CHECK(-f.dot(way) == Approx(slope).epsilon(1e-6));
    body.fem.forces(x + kStep * way, f_plus);
    body.fem.forces(x - kStep * way, f_minus);
    const VecX difference = (f_minus - f_plus) / (2.0 * kStep), product = k * way;
    CHECK((product - difference).norm() < 1e-5 * product.norm());
  }
}

TEST_CASE("quadratic elements: forces have no sum and no torque, a rotation has none at all") {
  test::Random random(74);
  for (const auto& entry : materials()) {
    CAPTURE(std::string(entry.name));
    DeformableBody body = test::make_body(irregular(), {.material = entry.name, .element = kQuadratic});
    const VecX x = deformed(body, 75, 0.02);
    VecX f;
    body.fem.forces(x, f);
    Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
    for (int i = 0; i < body.nodes(); ++i) {
      const Vec3 at = x.segment<3>(3 * i), force = f.segment<3>(3 * i);
      sum += force, torque += at.cross(force);
    }
    CHECK(sum.norm() < 1e-12 * f.norm());
    if (entry.name == "linear") continue;  // it knows no rotation
    CHECK(torque.norm() < 1e-11 * f.norm());
    const Mat3 turn = random.rotation();
    VecX turned = body.position;
    for (int i = 0; i < body.nodes(); ++i)
      turned.segment<3>(3 * i) = turn * body.fem.rest().vertices[i] + Vec3(3, -2, 5);
    VecX still;
    body.fem.forces(turned, still);
    CHECK(still.norm() < 1e-11 * f.norm());
  }
}

TEST_CASE("quadratic elements: both mass matrices weigh the body, the consistent one integrates x² exactly") {
  for (const MassKind kind : {MassKind::lumped, MassKind::consistent}) {
    DeformableBody body = test::make_body(irregular(), {.density = 800.0, .mass = kind, .element = kQuadratic});
    const double mass = 800.0 * total_volume(body.fem.rest());
    CHECK(body.fem.total_mass() == Approx(mass));
    for (int i = 0; i < body.nodes(); ++i) body.velocity.segment<3>(3 * i) = Vec3(1, 2, 3);
    CHECK(body.kinetic_energy() == Approx(0.5 * mass * 14.0));
    double truth = 0.0;  // ½ ρ ∫ x² dV, by the parts
    for (const Tet& t : body.fem.rest().tets) {
      Vec4 x;
      for (int k = 0; k < 4; ++k) x[k] = body.fem.rest().vertices[t[k]].x();
      truth += 0.5 * 800.0 * tet_volume(body.fem.rest(), t) * (x.squaredNorm() + x.sum() * x.sum()) / 20.0;
    }
    for (int i = 0; i < body.nodes(); ++i)
      body.velocity.segment<3>(3 * i) = Vec3(body.fem.rest().vertices[i].x(), 0, 0);
    CHECK(body.kinetic_energy() == Approx(truth).epsilon(kind == MassKind::consistent ? 1e-12 : 0.05));
  }
}
