#include "engine/geometry/tets/tet_cage.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "engine/core/parallel.hpp"
#include "engine/geometry/ray_columns.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;

namespace {

double volume_of(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
    sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
  return sum;
}

/// Part of a tetrahedron where a linear function with these corner values is positive: Σ d_i³/Π(d_i − d_j) over
/// positive d_i.
double positive_part(const Vec4& d) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    if (d[i] <= 0.0) continue;
    double product = 1.0;
    for (int j = 0; j < 4; ++j)
      if (j != i) product *= d[i] - d[j];
    sum += d[i] * d[i] * d[i] / product;
  }
  return sum;
}

/// All the surface's vertices are where the cage puts them, and the cage is a body.
void check_cage(const TetCage& cage, const TriangleMesh& surface) {
  CHECK_FALSE(check_tet_mesh(cage.mesh).has_value());
  CHECK(cage.dropped_rays == 0);
  CHECK(cage.embedding.outside == 0);
  REQUIRE(cage.embedding.tet.size() == surface.vertices.size());
  VecX x(3 * cage.mesh.vertices.size());
  for (std::size_t i = 0; i < cage.mesh.vertices.size(); ++i) x.segment<3>(3 * i) = cage.mesh.vertices[i];
  std::vector<Vec3> back;
  interpolate(cage.embedding, cage.mesh, x, back);
  double worst = 0.0;
  int missed = 0;
  for (std::size_t i = 0; i < back.size(); ++i) {
    missed += cage.embedding.tet[i] < 0;
    worst = std::max(worst, (back[i] - surface.vertices[i]).norm());
  }
  CHECK(missed == 0);
  CHECK(worst < 1e-11 * cage.cell_size);
}

}  // namespace

TEST_CASE("rays through a sphere, a torus and a dented body find the volume inside") {
  for (const TriangleMesh& mesh : {test::icosphere(4), test::torus(1.0, 0.3, 48, 24), test::bumpy_sphere(4)})
    for (int axis = 0; axis < 3; ++axis) {
      const double spacing = 0.01;
      const RayColumns columns(mesh, axis, spacing);
      CHECK(columns.dropped_rays() == 0);
      double sum = 0.0;
      const auto [i0, i1] = columns.u_range(-3, 3);
      const auto [j0, j1] = columns.v_range(-3, 3);
      for (int j = j0; j < j1; ++j)
        for (int i = i0; i < i1; ++i)
          for (const auto& interval : columns.inside(i, j)) sum += interval.high - interval.low;
      CHECK(sum * spacing * spacing == Approx(volume_of(mesh)).epsilon(5e-4));
    }
}

TEST_CASE("a cage takes closed surfaces of all kinds at any resolution") {
  for (const TriangleMesh& mesh : {test::icosphere(3), test::bumpy_sphere(4), test::torus(1.0, 0.25, 40, 20),
                                   test::box(Vec3(1, 0.3, 0.05)), test::bumpy_torus(60, 30)})
    for (const int cells : {1, 2, 5, 12}) {
      CAPTURE(cells);
      const TetCage cage = make_tet_cage(mesh, {.cells = cells});
      check_cage(cage, mesh);
      CHECK(component_count(cage.mesh) == 1);
      if (cells >= 5) CHECK(cage.filled_volume == Approx(volume_of(mesh)).epsilon(2e-3));
      for (const double f : cage.fraction) REQUIRE((f >= 0.02 && f <= 1.0));
    }
}

TEST_CASE("all tetrahedra of a cage have the shape of the body-centred cubic lattice") {
  const TetCage cage = make_tet_cage(test::bumpy_sphere(3), {.cells = 8});
  const double a = cage.cell_size;
  for (const Tet& t : cage.mesh.tets) {
    CHECK(tet_volume(cage.mesh, t) == Approx(a * a * a / 12.0).epsilon(1e-9));
    int long_edges = 0;
    for (const auto& [i, j] : kTetEdges) {
      const double length = (cage.mesh.vertices[t[i]] - cage.mesh.vertices[t[j]]).norm() / a;
      long_edges += std::abs(length - 1.0) < 1e-9;
      CHECK((std::abs(length - 1.0) < 1e-9 || std::abs(length - std::sqrt(0.75)) < 1e-9));
    }
    CHECK(long_edges == 2);
  }
}

TEST_CASE("filled fractions agree with the closed form for a plane cut") {
  // a turned box: elements near only one of its six planes are cut by that plane alone
  const Vec3 half(1.0, 0.8, 0.9);
  TriangleMesh mesh = test::box(half, Eigen::Vector3i(3, 3, 3));
  test::Random random(33);
  const Mat3 turn = random.rotation();
  for (Vec3& v : mesh.vertices) v = turn * v;
  const TetCage cage = make_tet_cage(mesh, {.cells = 12, .smallest_fraction = 0.0});
  int compared = 0;
  double square = 0.0;
  for (std::size_t e = 0; e < cage.mesh.tets.size(); ++e) {
    int cut = -1, cuts = 0;
    Vec4 inside;
    for (int plane = 0; plane < 6; ++plane) {
      Vec4 d;
      for (int k = 0; k < 4; ++k) {
        const Vec3 p = turn.transpose() * cage.mesh.vertices[cage.mesh.tets[e][k]];
        d[k] = half[plane / 2] - (plane % 2 == 0 ? p[plane / 2] : -p[plane / 2]);
      }
      if (d.minCoeff() > 0.0) continue;
      cut = plane;
      ++cuts;
      inside = d;
    }
    if (cuts == 0) CHECK(cage.fraction[e] == 1.0);
    if (cuts != 1 || inside.maxCoeff() <= 0.0) continue;
    const double error = cage.fraction[e] - positive_part(inside);
    CAPTURE(e, cut);
    CHECK(std::abs(error) < 0.015);
    square += error * error;
    ++compared;
  }
  CHECK(compared > 500);
  CHECK(std::sqrt(square / compared) < 0.003);
  CHECK(cage.filled_volume == Approx(8.0 * half.prod()).epsilon(1e-4));
}

TEST_CASE("surfaces that overlap themselves and bodies of two parts are caged") {
  TriangleMesh two = test::icosphere(3);
  const TriangleMesh other = two;
  const int n = static_cast<int>(two.vertices.size());
  for (const double shift : {1.5, 3.0}) {
    TriangleMesh both = two;
    for (const Vec3& v : other.vertices) both.vertices.push_back(v + Vec3(shift, 0, 0));
    for (const Triangle& t : other.triangles) both.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    const TetCage cage = make_tet_cage(both, {.cells = 14});
    check_cage(cage, both);
    CHECK(component_count(cage.mesh) == (shift < 2.0 ? 1 : 2));
    // where the spheres overlap, the volume counts once: 2 V − the lens π (4 + d)(2 − d)²/12
    const double lens = shift < 2.0 ? M_PI * (4.0 + shift) * (2.0 - shift) * (2.0 - shift) / 12.0 : 0.0;
    CHECK(cage.filled_volume == Approx(2.0 * volume_of(other) - lens).epsilon(5e-3));
  }
}

TEST_CASE("a cage does not depend on the number of threads") {
  const TriangleMesh mesh = test::bumpy_torus(60, 30);
  set_thread_count(1);
  const TetCage one = make_tet_cage(mesh, {.cells = 15});
  set_thread_count(4);
  const TetCage four = make_tet_cage(mesh, {.cells = 15});
  set_thread_count(0);
  CHECK(one.mesh.tets == four.mesh.tets);
  CHECK(one.fraction == four.fraction);
  CHECK(one.embedding.tet == four.embedding.tet);
}

TEST_CASE("the caged dragon: all of its vertices, no loose parts") {
  const std::string file = test::shared_file("meshes/dragon/dragon_20k.off");
  if (file.empty()) {
    WARN("no dragon at hand: skipped");
    return;
  }
  const TriangleMesh dragon = weld(read_mesh(file)).mesh;
  const TetCage cage = make_tet_cage(dragon, {.cells = 20});
  check_cage(cage, dragon);
  CHECK(component_count(cage.mesh) == 1);
  CHECK(cage.filled_volume == Approx(volume_of(dragon)).epsilon(1e-3));
}
