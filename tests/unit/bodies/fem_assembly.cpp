#include "engine/elements/fem_assembly.hpp"

#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

TetMesh irregular() {
  const Vec3 size(1.0, 0.7, 0.8);
  TetMesh mesh = make_tet_box(size, 3, 2, 3);
  test::shake_inside(mesh, size, 0.05, 51);
  // corners in another order, so that blocks come transposed too
  test::Random random(52);
  for (Tet& t : mesh.tets)
    if (random.u() < 0.5) t = {t[1], t[2], t[0], t[3]};
  return mesh;
}

VecX deformed(const DeformableBody& body, std::uint64_t seed, double amount = 0.05) {
  test::Random random(seed);
  VecX x = body.position;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += amount * random.sym();
  return x;
}

}  // namespace

TEST_CASE("assembled force and stiffness are the sums over the elements") {
  for (const auto& entry : materials()) {
    CAPTURE(std::string(entry.name));
    DeformableBody body = test::make_body(irregular(), {.material = entry.name});
    const VecX x = deformed(body, 53);
    VecX f, truth = VecX::Zero(x.size());
    BlockMatrix k(body.fem.pattern());
    const double energy = body.fem.stiffness(x, Tangent::exact, f, k);
    double sum = 0.0;
    MatX dense = MatX::Zero(x.size(), x.size());
    for (std::size_t e = 0; e < body.fem.elements().size(); ++e) {
      const Tet& tet = body.fem.rest().tets[e];
      Corners c;
      for (int a = 0; a < 4; ++a) c.col(a) = x.segment<3>(3 * tet[a]);
      ElementResponse out;
      body.fem.material(static_cast<int>(e)).response(body.fem.elements()[e], c, Tangent::exact, out);
      const Mat12 ke = full_stiffness(out);
      sum += out.energy;
      for (int a = 0; a < 4; ++a) {
        truth.segment<3>(3 * tet[a]) += out.force.col(a);
        for (int b = 0; b < 4; ++b) dense.block<3, 3>(3 * tet[a], 3 * tet[b]) += ke.block<3, 3>(3 * a, 3 * b);
      }
    }
    CHECK(energy == Approx(sum).epsilon(1e-13));
    CHECK(body.fem.energy(x) == Approx(sum).epsilon(1e-13));
    CHECK((f - truth).norm() < 1e-12 * truth.norm());
    VecX alone;
    body.fem.forces(x, alone);
    CHECK((alone - truth).norm() < 1e-12 * truth.norm());
    const VecX v = deformed(body, 54);
    CHECK((k * v - dense * v).norm() < 1e-12 * (dense * v).norm());
  }
}

TEST_CASE("assembly gives the same bits for any number of threads") {
  const auto element = GENERATE(ElementKind::linear, ElementKind::quadratic);
  const int cells = element == ElementKind::linear ? 8 : 5;
  DeformableBody body =
      test::make_body(make_tet_box(Vec3::Ones(), cells, cells, cells), {.material = "neo_hookean", .element = element});
  const VecX x = deformed(body, 55, 0.02);
  VecX f1, f2;
  BlockMatrix k1(body.fem.pattern()), k2(body.fem.pattern());
  set_thread_count(1);
  const double e1 = body.fem.stiffness(x, Tangent::automatic, f1, k1);
  set_thread_count(4);
  const double e2 = body.fem.stiffness(x, Tangent::automatic, f2, k2);
  set_thread_count(0);
  CHECK(e1 == e2);
  CHECK((f1.array() == f2.array()).all());
  bool same = true;
  for (int i = 0; i < k1.pattern->blocks(); ++i) same = same && k1.values[i] == k2.values[i];
  CHECK(same);
}

TEST_CASE("both mass matrices weigh the body, and the consistent one integrates velocities exactly") {
  for (const MassKind kind : {MassKind::lumped, MassKind::consistent}) {
    DeformableBody body = test::make_body(irregular(), {.density = 800.0, .mass = kind});
    const double mass = 800.0 * total_volume(body.fem.rest());
    CHECK(body.fem.total_mass() == Approx(mass));
    for (int i = 0; i < body.nodes(); ++i) body.velocity.segment<3>(3 * i) = Vec3(1, 2, 3);
    CHECK(body.kinetic_energy() == Approx(0.5 * mass * 14.0));
    CHECK((body.momentum() - mass * Vec3(1, 2, 3)).norm() < 1e-9);
    // a velocity field v = x e_x: ½ ρ ∫ x² dV, which linear shape functions integrate exactly
    double truth = 0.0;
    for (const Tet& t : body.fem.rest().tets) {
      Vec4 x;
      for (int k = 0; k < 4; ++k) x[k] = body.fem.rest().vertices[t[k]].x();
      truth += 0.5 * 800.0 * tet_volume(body.fem.rest(), t) * (x.squaredNorm() + x.sum() * x.sum()) / 20.0;
    }
    for (int i = 0; i < body.nodes(); ++i)
      body.velocity.segment<3>(3 * i) = Vec3(body.fem.rest().vertices[i].x(), 0, 0);
    if (kind == MassKind::consistent)
      CHECK(body.kinetic_energy() == Approx(truth).epsilon(1e-12));
    else
      CHECK(body.kinetic_energy() > truth);
  }
}

TEST_CASE("filled fractions weigh mass and stiffness alike") {
  const TetMesh mesh = irregular();
  std::vector<double> half(mesh.tets.size(), 0.5);
  std::shared_ptr<const Material> material = test::make_material("stvk");
  FemAssembly full(mesh, {{material, 1000.0}}, MassKind::lumped),
      part(mesh, {{material, 1000.0}}, MassKind::lumped, {}, half);
  DeformableBody body(full);
  const VecX x = deformed(body, 56);
  CHECK(part.energy(x) == Approx(0.5 * full.energy(x)));
  CHECK(part.total_mass() == Approx(0.5 * full.total_mass()));
}

TEST_CASE("elements may differ in material, and materials may change") {
  const TetMesh mesh = irregular();
  std::vector<int> which(mesh.tets.size(), 0);
  for (std::size_t e = 0; e < which.size(); e += 2) which[e] = 1;
  std::shared_ptr<const Material> soft = test::make_material("corotational", 1e4),
                                  hard = test::make_material("corotational", 1e6);
  FemAssembly mixed(mesh, {{soft, 500.0}, {hard, 1500.0}}, MassKind::lumped, which);
  FemAssembly all_soft(mesh, {{soft, 500.0}}, MassKind::lumped), all_hard(mesh, {{hard, 1500.0}}, MassKind::lumped);
  const VecX x = deformed(DeformableBody(all_soft), 57);
  CHECK(mixed.energy(x) > all_soft.energy(x));
  CHECK(mixed.energy(x) < all_hard.energy(x));
  mixed.set_material(0, {hard, 1500.0});
  CHECK(mixed.energy(x) == Approx(all_hard.energy(x)));
  CHECK(mixed.total_mass() == Approx(all_hard.total_mass()));
}

TEST_CASE("held nodes leave the system") {
  DeformableBody body = test::make_body(irregular());
  const int all = body.dofs();
  const std::vector<int> held = test::nodes_where(body, [](const Vec3& p) { return p.x() < 1e-9; });
  REQUIRE(held.size() == 12);
  body.hold(held);
  CHECK(body.dofs() == all - 36);
  VecX v = VecX::LinSpaced(all, 1.0, 2.0), back = VecX::Zero(all);
  body.scatter_free(body.gather_free(v), back);
  for (int i = 0; i < body.nodes(); ++i) {
    CHECK(body.is_held(i) == (std::count(held.begin(), held.end(), i) == 1));
    CHECK((back.segment<3>(3 * i) - (body.is_held(i) ? VecX(VecX::Zero(3)) : VecX(v.segment<3>(3 * i)))).norm() == 0.0);
  }
  body.hold({});
  CHECK(body.dofs() == all);
}
