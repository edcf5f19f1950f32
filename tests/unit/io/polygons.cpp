// Polygons, strips and several objects of a file as triangles: areas by the shoelace formula, nothing covered twice.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/meshes/polygon.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double covered(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const Vec3& normal,
               bool& all_face_it) {
  double area = 0.0;
  for (const Triangle& t : triangles) {
    const double a = 0.5 * (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]).dot(normal);
    all_face_it = all_face_it && a > -1e-12;
    area += std::abs(a);
  }
  return area;
}

}  // namespace

TEST_CASE("concave polygons are covered once, in any plane") {
  Random random(9);
  for (int trial = 0; trial < 300; ++trial) {
    // a star: the angle grows, the radius is anything
    const int n = 4 + random.below(60);
    const Mat3 rotation = random.rotation();
    const Vec3 shift = 10.0 * random.vector();
    std::vector<Vec3> vertices;
    std::vector<int> corners;
    double area = 0.0;
    std::vector<Vec3> flat;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * M_PI * i / n, radius = random.in(0.1, 1.0);
      flat.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0);
      corners.push_back(i);
    }
    for (int i = 0; i < n; ++i) area += 0.5 * flat[i].cross(flat[(i + 1) % n]).z();
    for (const Vec3& x : flat) vertices.push_back(rotation * x + shift);
    std::vector<Triangle> triangles;
    append_polygon(corners, vertices, triangles);
    REQUIRE(static_cast<int>(triangles.size()) == n - 2);
    bool all_face_it = true;
    CHECK(covered(vertices, triangles, rotation.col(2), all_face_it) == Approx(area).epsilon(1e-9));
    CHECK(all_face_it);
  }
}

TEST_CASE("a concave quad in each format, and an L with corners in a row") {
  const std::string dart = "0 0 0\n2 -1 0\n0.5 0 0\n2 1 0\n";
  for (const TriangleMesh& mesh :
       {parse_mesh("a.off", "OFF\n4 1 0\n" + dart + "4 1 2 3 0\n"),
        parse_mesh("a.obj", "v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\nf 2 3 4 1\n"),
        parse_mesh("a.ply",
                   "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
                   "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                       dart + "4 1 2 3 0\n")}) {
    bool all_face_it = true;
    CHECK(covered(mesh.vertices, mesh.triangles, Vec3::UnitZ(), all_face_it) == Approx(0.5));
    CHECK(all_face_it);
  }
  const TriangleMesh l = parse_mesh("a.obj",
                                    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 1 0\n"
                                    "f 5 6 7 8 1 2 3 4\nf 1 2 3 4 5 6 7 8\n");
  bool all_face_it = true;
  CHECK(covered(l.vertices, l.triangles, Vec3::UnitZ(), all_face_it) == Approx(6.0));
  CHECK(all_face_it);
}

TEST_CASE("strips of PLY are triangles that face alike, and begin anew at -1") {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement "
      "tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  std::string vertices;
  for (int i = 0; i < 8; ++i) vertices += fmt::format("{} {} 0\n", i / 2, i % 2);
  const TriangleMesh strip = parse_mesh("a.ply", head + vertices + "9 0 2 1 3 -1 4 6 5 7\n");
  CHECK(strip.triangles == std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}, {4, 6, 5}, {5, 6, 7}});
  CHECK(parse_mesh("a.ply", head + vertices + "6 0 2 1 1 3 5\n").triangles.size() == 2);  // a corner is turned
  CHECK_THROWS_WITH(parse_mesh("a.ply", head + vertices + "3 0 2 8\n"), Catch::Contains("vertex 8"));
  CHECK_THROWS_WITH(parse_mesh("a.ply", head + vertices + "3 0 2 -2\n"), Catch::Contains("vertex -2"));
}
