// Volume integrals against closed formulas, and their covariance.
#include <catch2/catch.hpp>

#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {
TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& v : mesh.vertices) v = pose.apply(v);
  return mesh;
}
}  // namespace

TEST_CASE("a box's mesh has the box's mass, centre and inertia") {
  const Vec3 half(0.3, 0.7, 0.45);
  const MassProperties exact = box_mass(half, 500.0);
  CHECK(exact.mass == Approx(500.0 * 0.6 * 1.4 * 0.9).epsilon(1e-15));
  CHECK(exact.inertia(0, 0) == Approx(exact.mass / 12.0 * (1.4 * 1.4 + 0.9 * 0.9)).epsilon(1e-15));
  for (const Eigen::Vector3i& cells : {Eigen::Vector3i(1, 1, 1), Eigen::Vector3i(3, 4, 5)}) {
    const MassProperties mesh = mesh_mass(box(half, cells), 500.0);
    CHECK(mesh.mass == Approx(exact.mass).epsilon(1e-13));
    CHECK(mesh.center.norm() < 1e-13);
    CHECK((mesh.inertia - exact.inertia).norm() < 1e-13 * exact.inertia.norm());
  }
  CHECK(SharedShape(Box{half})->mass(500.0).mass == exact.mass);
  CHECK(SharedShape(make_box_mesh(half))->mass(500.0).mass == Approx(exact.mass).epsilon(1e-13));
  CHECK(SharedShape(Plane{})->mass(500.0).mass == 0.0);
}

TEST_CASE("icospheres converge to the sphere with the square of the edge") {
  const MassProperties exact = sphere_mass(0.5, 1000.0);
  CHECK(exact.mass == Approx(1000.0 * 4.0 / 3.0 * M_PI * 0.125).epsilon(1e-15));
  double before = 0.0;
  for (int k = 1; k <= 5; ++k) {
    const MassProperties mesh = mesh_mass(icosphere(k, 0.5), 1000.0);
    const double error = 1.0 - mesh.mass / exact.mass;
    CHECK(error > 0.0);
    if (k > 2) CHECK(before / error == Approx(4.0).epsilon(0.05));
    before = error;
    // to first order the radius is short by error/3, and the inertia grows with its fifth power
    CHECK(1.0 - mesh.inertia(1, 1) / exact.inertia(1, 1) == Approx(5.0 / 3.0 * error).epsilon(0.15));
  }
  CHECK(before < 2e-3);
}

TEST_CASE("a capsule is its cylinder and two half balls") {
  const double r = 0.3, h = 0.5;
  CHECK(capsule_mass(r, 0.0, 700.0).inertia.isApprox(sphere_mass(r, 700.0).inertia, 1e-14));
  const MassProperties exact = capsule_mass(r, h, 700.0);
  // a surface of revolution, fine enough for 1e-4
  TriangleMesh mesh;
  const int rings = 200, around = 200;
  mesh.vertices = {{0, -h - r, 0}, {0, h + r, 0}};
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = M_PI * i / rings, azimuth = 2.0 * M_PI * j / around;
      const double y = -r * std::cos(polar);
      mesh.vertices.emplace_back(r * std::sin(polar) * std::cos(azimuth),
                                 y + (i < rings / 2   ? -h
                                      : i > rings / 2 ? h
                                                      : 0.0),
                                 r * std::sin(polar) * std::sin(azimuth));
    }
  const auto at = [&](int i, int j) { return i == 0 ? 0 : i == rings ? 1 : 2 + (i - 1) * around + j % around; };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const int a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
      if (i > 0) mesh.triangles.push_back({a, c, b});
      if (i < rings - 1) mesh.triangles.push_back({a, d, c});
    }
  const MassProperties meshed = mesh_mass(mesh, 700.0);
  CHECK(meshed.mass == Approx(exact.mass).epsilon(1e-3));
  CHECK(meshed.inertia(0, 0) == Approx(exact.inertia(0, 0)).epsilon(2e-3));
  CHECK(meshed.inertia(1, 1) == Approx(exact.inertia(1, 1)).epsilon(2e-3));
  CHECK(meshed.inertia(2, 2) == Approx(exact.inertia(2, 2)).epsilon(2e-3));
}

TEST_CASE("a tetrahedron's mass properties follow its formula") {
  // corners 0, a e_x, b e_y, c e_z: V = abc/6, centre (a, b, c)/4, central second moments V 3/80 a² and -V/80 ab
  const double a = 0.7, b = 1.1, c = 0.4;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MassProperties m = mesh_mass(mesh, 1.0);
  const double v = a * b * c / 6.0;
  CHECK(m.mass == Approx(v).epsilon(1e-14));
  CHECK((m.center - 0.25 * Vec3(a, b, c)).norm() < 1e-15);
  Mat3 expected;
  expected << 3 * (b * b + c * c), a * b, a * c, a * b, 3 * (a * a + c * c), b * c, a * c, b * c, 3 * (a * a + b * b);
  CHECK((m.inertia - v / 80.0 * expected).norm() < 1e-15);
  CHECK(signed_volume(mesh) == Approx(v).epsilon(1e-14));
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  CHECK(signed_volume(mesh) == Approx(-v).epsilon(1e-14));
  CHECK(mesh_mass(mesh, 1.0).mass < 0.0);
  CHECK(mesh_mass(TriangleMesh{}, 1.0).mass == 0.0);
}

TEST_CASE("mass properties turn and move with the mesh, also far away") {
  Random r(3);
  const TriangleMesh mesh = bumpy_sphere(3);
  const MassProperties here = mesh_mass(mesh, 800.0);
  for (int i = 0; i < 20; ++i) {
    const Pose pose{r.rotation(), 10.0 * r.vector()};
    const MassProperties there = mesh_mass(moved(mesh, pose), 800.0);
    CHECK(there.mass == Approx(here.mass).epsilon(1e-12));
    CHECK((there.center - pose.apply(here.center)).norm() < 1e-12);
    CHECK((there.inertia - pose.rotation * here.inertia * pose.rotation.transpose()).norm() <
          1e-12 * here.inertia.norm());
  }
  // at 1e6 m a coordinate has 1e-10 m left; nothing more may be lost
  const MassProperties far = mesh_mass(moved(mesh, {Mat3::Identity(), Vec3(1e6, -1e6, 1e6)}), 800.0);
  CHECK(far.mass == Approx(here.mass).epsilon(1e-9));
  CHECK((far.inertia - here.inertia).norm() < 1e-9 * here.inertia.norm());
}

TEST_CASE("mesh checks name the first problem and its remedy") {
  const auto problem = [](const TriangleMesh& mesh) { return check_mesh(mesh, make_topology(mesh)).value_or(""); };
  const auto starts = [](const std::string& text, const std::string& with) {
    return text.rfind(with, 0) == 0 && text.find("; ") != std::string::npos;
  };
  const TriangleMesh good = icosphere(1, 1.0);
  CHECK(problem(good).empty());
  CHECK(starts(check_indices(TriangleMesh{}).value_or(""), "has no triangles"));

  TriangleMesh mesh = good;
  mesh.triangles.erase(mesh.triangles.begin() + 4);
  CHECK(starts(problem(mesh), "is not closed: 3 border edges, first between vertices "));
  CHECK(problem(sheet(1.0, 2)).find("8 border edges") != std::string::npos);

  mesh = good;
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  CHECK(starts(problem(mesh), "is inside out"));

  mesh = good;
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  CHECK(starts(problem(mesh), "is not oriented: neighbouring triangles face opposite ways across 3 edges"));

  mesh = good;
  mesh.vertices.push_back({0, 3, 0});
  const int top = static_cast<int>(mesh.vertices.size()) - 1;
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], top});
  CHECK(starts(problem(mesh), "is not manifold: 1 edge with three or more triangles"));

  mesh = good;
  mesh.vertices[5].y() = std::nan("");
  CHECK(starts(check_indices(mesh).value_or(""), "has a vertex that is not finite: vertex 5"));
  mesh = good;
  mesh.triangles[3][2] = 42;
  CHECK(starts(check_indices(mesh).value_or(""),
               "has an index out of range: triangle 3 names vertex 42, allowed are 0 to 41"));
  mesh.triangles[3][2] = -1;
  CHECK(check_indices(mesh).has_value());
  mesh.triangles[3] = {1, 2, 1};
  CHECK(starts(check_indices(mesh).value_or(""), "has a degenerate triangle: triangle 3"));

  TriangleMesh flat;  // both sides of one triangle
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  CHECK(starts(problem(flat), "encloses no volume"));
}

TEST_CASE("welding joins vertices of equal position and keeps the order") {
  const TriangleMesh good = icosphere(1, 1.0);
  TriangleMesh soup;  // every triangle with corners of its own, as STL files have them
  for (const Triangle& t : good.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (int v : t) soup.vertices.push_back(good.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  CHECK(make_topology(soup).border_edges == 3 * static_cast<int>(good.triangles.size()));
  const WeldedMesh welded = weld(soup);
  CHECK(welded.mesh.vertices.size() == good.vertices.size());
  CHECK(make_topology(welded.mesh).is_closed());
  for (std::size_t v = 0; v < soup.vertices.size(); ++v)
    REQUIRE(welded.mesh.vertices[welded.new_vertex[v]] == soup.vertices[v]);
  CHECK(welded.new_vertex[0] == 0);

  soup.vertices[0] = {0.0, -0.0, 0.0};
  soup.vertices[1] = {-0.0, 0.0, 0.0};
  const WeldedMesh collapsed = weld(soup);
  CHECK(collapsed.new_vertex[1] == 0);
  CHECK(collapsed.mesh.triangles.size() == soup.triangles.size() - 1);
  CHECK(collapsed.old_triangle.front() == 1);
  soup.vertices[4].x() = std::nan("");
  soup.vertices[9].x() = std::nan("");
  const WeldedMesh odd = weld(soup);  // what isn't a number equals nothing
  CHECK(odd.new_vertex[4] != odd.new_vertex[9]);
}
