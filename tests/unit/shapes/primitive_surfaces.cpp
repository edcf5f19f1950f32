// Tessellated exact shapes and the regular lattice of a box, against formulas.
#include "engine/shapes/primitives.hpp"

#include <catch2/catch.hpp>

#include <numbers>

#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/tets/tet_mesh.hpp"

using namespace impinge;

namespace {

bool bounds_a_solid(const TriangleMesh& mesh) { return !check_mesh(mesh, make_topology(mesh)).has_value(); }

}  // namespace

TEST_CASE("tessellated shapes are closed, outward, and converge to the shape's volume") {
  const double pi = std::numbers::pi;
  const double ball = 4.0 / 3.0 * pi * 0.027, pill = ball + pi * 0.09 * 0.8;  // r = 0.3, half length 0.4
  double last_ball = 1.0, last_pill = 1.0;
  for (int k = 0; k < 4; ++k) {
    const TriangleMesh sphere = sphere_surface(0.3, k), capsule = capsule_surface(0.3, 0.4, 8 << k);
    CHECK(bounds_a_solid(sphere));
    CHECK(bounds_a_solid(capsule));
    for (const Vec3& v : sphere.vertices) CHECK(v.norm() == Approx(0.3).epsilon(1e-12));
    for (const Vec3& v : capsule.vertices)
      CHECK((v - Vec3(0, std::clamp(v.y(), -0.4, 0.4), 0)).norm() == Approx(0.3).epsilon(1e-12));
    // inscribed, so from below; half the edge leaves a quarter of the error
    const double ball_error = 1.0 - signed_volume(sphere) / ball, pill_error = 1.0 - signed_volume(capsule) / pill;
    CHECK(ball_error > 0.0);
    CHECK(pill_error > 0.0);
    if (k > 0) {
      CHECK(ball_error < last_ball / 3.0);
      CHECK(pill_error < last_pill / 3.0);
    }
    last_ball = ball_error;
    last_pill = pill_error;
  }
  CHECK(last_ball < 0.01);
  CHECK(last_pill < 0.01);
  const TriangleMesh box = box_surface(Vec3(1, 2, 3), Eigen::Vector3i(2, 3, 4));
  CHECK(bounds_a_solid(box));
  CHECK(signed_volume(box) == Approx(48.0));
  CHECK(box.triangles.size() == 4 * (2 * 3 + 3 * 4 + 4 * 2));
}

TEST_CASE("the alternating box is a body without a favoured direction") {
  for (const auto& n : {Eigen::Vector3i(1, 1, 1), Eigen::Vector3i(2, 3, 4), Eigen::Vector3i(4, 4, 4)}) {
    const TetMesh mesh = make_alternating_box(Vec3(1, 2, 3), n.x(), n.y(), n.z());
    CHECK_FALSE(check_tet_mesh(mesh).has_value());
    CHECK(mesh.tets.size() == static_cast<std::size_t>(5 * n.prod()));
    CHECK(total_volume(mesh) == Approx(6.0));
    CHECK(boundary_triangles(mesh).size() ==
          static_cast<std::size_t>(4 * (n.x() * n.y() + n.y() * n.z() + n.z() * n.x())));
  }
  // mirrored in any axis, a cube of an even number of cells is itself
  const TetMesh mesh = make_alternating_box(Vec3::Constant(2.0), 2, 2, 2);
  const auto key = [](std::array<Vec3, 4> corners) {
    std::array<std::array<int, 3>, 4> k;
    for (int i = 0; i < 4; ++i)
      k[i] = {static_cast<int>(corners[i].x()), static_cast<int>(corners[i].y()), static_cast<int>(corners[i].z())};
    std::sort(k.begin(), k.end());
    return k;
  };
  const auto keys = [&](int mirrored) {
    std::vector<std::array<std::array<int, 3>, 4>> all;
    for (const Tet& t : mesh.tets) {
      std::array<Vec3, 4> corners;
      for (int i = 0; i < 4; ++i) {
        corners[i] = mesh.vertices[t[i]];
        if (mirrored >= 0) corners[i][mirrored] = 2.0 - corners[i][mirrored];
      }
      all.push_back(key(corners));
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  for (int axis = 0; axis < 3; ++axis) CHECK(keys(axis) == keys(-1));
}

TEST_CASE("the smallest dihedral angle is that of known tetrahedra") {
  TetMesh mesh;
  mesh.vertices = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  mesh.tets = {{0, 1, 2, 3}};
  if (total_volume(mesh) < 0) std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  CHECK(smallest_dihedral_angle(mesh) == Approx(70.528779).epsilon(1e-7));  // regular: arccos 1/3
  // arctan √2
  CHECK(smallest_dihedral_angle(make_alternating_box(Vec3::Ones(), 2, 2, 2)) == Approx(54.735610).epsilon(1e-7));
  CHECK(smallest_dihedral_angle(make_tet_box(Vec3::Ones(), 2, 2, 2)) == Approx(45.0).epsilon(1e-9));
}
