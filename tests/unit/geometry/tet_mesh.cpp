#include "engine/geometry/tets/tet_mesh.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/tets/embedding.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

TetMesh shaken_box() {
  TetMesh mesh = make_tet_box(Vec3(1, 2, 3), 3, 4, 5);
  test::Random random(31);
  for (Vec3& v : mesh.vertices) v += 0.05 * random.vector();
  return mesh;
}

}  // namespace

TEST_CASE("a tetrahedral box fills its box and has its closed surface outside") {
  const TetMesh mesh = make_tet_box(Vec3(1, 2, 3), 3, 4, 5);
  CHECK(mesh.tets.size() == 3 * 4 * 5 * 6);
  CHECK(total_volume(mesh) == Approx(6.0));
  CHECK_FALSE(check_tet_mesh(mesh).has_value());
  const TriangleMesh surface{mesh.vertices, boundary_triangles(mesh)};
  CHECK(surface.triangles.size() == 4 * (3 * 4 + 4 * 5 + 5 * 3));
  double volume = 0.0;
  for (const Triangle& t : surface.triangles)
    volume += surface.vertices[t[0]].dot(surface.vertices[t[1]].cross(surface.vertices[t[2]])) / 6.0;
  CHECK(volume == Approx(6.0));
  CHECK(make_topology(surface).is_closed());
  // Vega's yardstick mesh: all six tetrahedra of a cell share the diagonal from its lowest to its highest corner
  for (const Tet& tet : make_tet_box(Vec3::Ones(), 1, 1, 1).tets) {
    CHECK(std::count(tet.begin(), tet.end(), 0) == 1);
    CHECK(std::count(tet.begin(), tet.end(), 7) == 1);
  }
}

TEST_CASE("the boundary of an irregular mesh encloses the volume of its tetrahedra") {
  const TetMesh mesh = shaken_box();
  double volume = 0.0;
  for (const Triangle& t : boundary_triangles(mesh))
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
  CHECK(volume == Approx(total_volume(mesh)).epsilon(1e-12));
}

TEST_CASE("what keeps tetrahedra from being a body is named") {
  const auto problem = [](auto change) {
    TetMesh mesh = make_tet_box(Vec3::Ones(), 2, 2, 2);
    change(mesh);
    return check_tet_mesh(mesh, 1).value_or("nothing");
  };
  using Catch::Matchers::Contains;
  CHECK(problem([](TetMesh&) {}) == "nothing");
  CHECK_THAT(problem([](TetMesh& m) { m.tets.clear(); }), Contains("no tetrahedra"));
  CHECK_THAT(problem([](TetMesh& m) { m.tets[3][1] = 99; }), Contains("vertex 100 in tetrahedron 4"));
  CHECK_THAT(problem([](TetMesh& m) { m.tets[3][1] = m.tets[3][2]; }), Contains("twice in tetrahedron 4"));
  CHECK_THAT(problem([](TetMesh& m) { m.vertices[5].x() = std::numeric_limits<double>::quiet_NaN(); }),
             Contains("not finite at vertex 6"));
  CHECK_THAT(problem([](TetMesh& m) { std::swap(m.tets[7][0], m.tets[7][1]); }), Contains("inverted tetrahedron 8"));
  CHECK_THAT(problem([](TetMesh& m) { m.tets.push_back(m.tets[0]), m.tets.push_back(m.tets[0]); }),
             Contains("1, 49 and 50"));
  CHECK_THAT(problem([](TetMesh& m) { m.vertices.emplace_back(5, 5, 5); }), Contains("vertex 28 in no tetrahedron"));
  CHECK_THAT(problem([](TetMesh& m) { m.vertices[m.tets[2][1]] = m.vertices[m.tets[2][0]]; }), Contains("flat"));
}

TEST_CASE("parts are counted by shared vertices") {
  TetMesh mesh = make_tet_box(Vec3::Ones(), 2, 2, 2);
  CHECK(component_count(mesh) == 1);
  const int n = static_cast<int>(mesh.vertices.size());
  const TetMesh other = make_tet_box(Vec3::Ones(), 1, 1, 1);
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(3, 0, 0));
  for (const Tet& t : other.tets) mesh.tets.push_back({t[0] + n, t[1] + n, t[2] + n, t[3] + n});
  CHECK(component_count(mesh) == 2);
}

TEST_CASE("points are embedded where they are, and follow an affine motion exactly") {
  const TetMesh mesh = shaken_box();
  test::Random random(32);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) {
    const Tet& t = mesh.tets[random.below(static_cast<int>(mesh.tets.size()))];
    Vec4 w(random.u(), random.u(), random.u(), random.u());
    if (i % 5 == 0) w[0] = 0.0;
    if (i % 25 == 0) w = Vec4(0, 0, 1, 0);
    w /= w.sum();
    points.push_back(w[0] * mesh.vertices[t[0]] + w[1] * mesh.vertices[t[1]] + w[2] * mesh.vertices[t[2]] +
                     w[3] * mesh.vertices[t[3]]);
  }
  const Embedding embedding = embed(mesh, points);
  CHECK(embedding.outside == 0);
  CHECK(embedding.farthest < 1e-12);
  Mat3 a;
  for (int k = 0; k < 9; ++k) a(k % 3, k / 3) = random.sym();
  VecX x(3 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) x.segment<3>(3 * i) = a * mesh.vertices[i] + Vec3(1, 2, 3);
  std::vector<Vec3> moved;
  interpolate(embedding, mesh, x, moved);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(embedding.weight[i].sum() == Approx(1.0));
    CHECK((moved[i] - (a * points[i] + Vec3(1, 2, 3))).norm() < 1e-12);
  }
}

TEST_CASE("points outside the mesh go to the tetrahedron that stretches least, and are counted") {
  const TetMesh mesh = make_tet_box(Vec3::Ones(), 4, 4, 4);
  const std::vector<Vec3> points = {Vec3(0.5, 0.5, 1.01), Vec3(-0.02, 0.5, 0.5), Vec3(3, 3, 3), Vec3(0.5, 0.5, 0.5)};
  const Embedding embedding = embed(mesh, points);
  CHECK(embedding.outside == 3);
  VecX x(3 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) x.segment<3>(3 * i) = mesh.vertices[i];
  std::vector<Vec3> back;
  interpolate(embedding, mesh, x, back);
  for (std::size_t i = 0; i < points.size(); ++i) CHECK((back[i] - points[i]).norm() < 1e-12);
  CHECK(embedding.weight[0].minCoeff() > -0.1);
  CHECK(embedding.weight[1].minCoeff() > -0.1);
}
