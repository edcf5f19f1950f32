// What a searched mesh answers is what going through all triangles does.
#include "engine/geometry/surface/searched_mesh.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/surface/inner_points.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Open, with hills: nothing is wholly inside it, and solid angles are no whole numbers.
TriangleMesh hills(int n) {
  TriangleMesh mesh = sheet(1.0, n);
  for (Vec3& v : mesh.vertices)
    v.y() = 0.3 * std::sin(5.0 * v.x()) * std::cos(4.0 * v.z()) - 0.4 * (v.x() * v.x() + v.z() * v.z());
  return mesh;
}

/// No two triangles share a vertex.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int v : t) soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::vector<TriangleMesh> all_meshes() {
  TriangleMesh shell = icosphere(4, 1.0), overlapping = icosphere(3, 0.7), loose = hills(12);
  append(shell, inside_out(icosphere(4, 0.8)));
  TriangleMesh other = icosphere(3, 0.6);
  for (Vec3& v : other.vertices) v += Vec3(0.5, 0.2, 0.1);
  append(overlapping, other);
  append(overlapping, icosphere(2, 0.3));  // inside the first one: its winding numbers reach 3
  loose.vertices.emplace_back(0.1, 0.2, 0.3);
  TriangleMesh doubled = hills(10);
  doubled.triangles.insert(doubled.triangles.end(), doubled.triangles.begin(), doubled.triangles.begin() + 70);
  return {hills(40), bumpy_torus(40, 24), shell, overlapping, soup_of(icosphere(3, 0.9)), loose,
          doubled,   box({0.5, 0.4, 0.3})};
}

/// Of two poses: as made, and turned far from the origin.
std::vector<Vec3> posed(const TriangleMesh& mesh, bool is_turned) {
  std::vector<Vec3> vertices = mesh.vertices;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  if (is_turned)
    for (Vec3& v : vertices) v = turn * v + Vec3(37.0, -12.0, 5.0);
  return vertices;
}

double first_hit(const TriangleMesh& mesh, const std::vector<Vec3>& vertices, const Vec3& x, const Vec3& direction,
                 int except) {
  double way = INFINITY;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Triangle& c = mesh.triangles[static_cast<std::size_t>(t)];
    const auto hit = intersect_line(x, direction, {vertices[c[0]], vertices[c[1]], vertices[c[2]]}, 1e-9);
    if (t != except && hit && hit->t > 0.0) way = std::min(way, hit->t);
  }
  return way;
}

}  // namespace

TEST_CASE("a searched mesh winds round points and is as far from them as all its triangles say") {
  Random random(31);
  int inside = 0, outside = 0, by_rims = 0;
  for (const TriangleMesh& mesh : all_meshes())
    for (const bool is_turned : {false, true}) {
      const std::vector<Vec3> vertices = posed(mesh, is_turned);
      const MeshPointer made = make_surface(mesh);
      const NodeRims rims(made->tree(), mesh.triangles);
      const SearchedMesh searched(*made, vertices, &rims), plain(*made, vertices);
      for (int i = 0; i < 150; ++i) {
        // on the surface, beside it, near it and far off
        const int t = static_cast<int>(random.in(0.0, static_cast<double>(mesh.triangles.size()) - 1e-9));
        const TriangleCorners c = searched.corners(t);
        const double aside = i % 5 == 0 ? 0.0 : std::pow(10.0, random.in(-12.0, 0.5));
        const Vec3 x = (c[0] + c[1] + c[2]) / 3.0 + aside * random.direction();
        const double all = winding_number(x, vertices, mesh.triangles), found = searched.winding(x);
        CAPTURE(mesh.triangles.size(), is_turned, i, aside);
        if (aside > 1e-11) CHECK(found == Approx(all).margin(1e-9));
        CHECK((found > 0.5) == (all > 0.5));
        CHECK((found < 0.5) == (all < 0.5));
        CHECK((plain.winding(x) > 0.5) == (all > 0.5));
        CHECK(searched.distance(x) == distance_to_surface(x, vertices, mesh.triangles));
        (all > 0.5 ? inside : outside) += 1;
        by_rims += found != plain.winding(x);
      }
    }
  CHECK(inside > 200);
  CHECK(outside > 200);
  CHECK(by_rims > 200);  // the sum has other terms
}

TEST_CASE("a searched mesh finds the triangles, vertices and ways that all its triangles have") {
  Random random(32);
  std::size_t hits = 0, near = 0;
  for (const TriangleMesh& mesh : all_meshes())
    for (const bool is_turned : {false, true}) {
      const std::vector<Vec3> vertices = posed(mesh, is_turned);
      const MeshPointer made = make_surface(mesh);
      const SearchedMesh searched(*made, vertices);
      const int count = static_cast<int>(mesh.triangles.size());
      for (int i = 0; i < 40; ++i) {
        const int t = static_cast<int>(random.in(0.0, count - 1e-9));
        const TriangleCorners c = searched.corners(t);
        const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
        // any way, and within a plane of the surface, which a line has nothing of but its rounding
        const Vec3 direction = i % 2 == 0 ? random.direction() : Vec3((c[1] - c[0]).normalized());
        const double way = searched.way_along(middle, direction, 1e-9, t);
        CHECK(way == first_hit(mesh, vertices, middle, direction, t));
        hits += std::isfinite(way);
        const Aabb region = Aabb{middle, middle}.inflated(std::pow(10.0, random.in(-6.0, 0.0)));
        std::set<int> triangles, corners;
        for (int k = 0; k < count; ++k) {
          const Triangle& of = mesh.triangles[static_cast<std::size_t>(k)];
          if (overlap(bounds_of(vertices[of[0]], vertices[of[1]], vertices[of[2]]), region)) triangles.insert(k);
        }
        for (int v = 0; v < static_cast<int>(vertices.size()); ++v)
          if (overlap(Aabb{vertices[v], vertices[v]}, region)) corners.insert(v);
        const std::vector<int> found = searched.triangles_near(region), seen = searched.vertices_near(region);
        CHECK(std::set<int>(found.begin(), found.end()) == triangles);
        CHECK(found.size() == triangles.size());
        CHECK(std::includes(seen.begin(), seen.end(), corners.begin(), corners.end()));
        near += triangles.size();
      }
    }
  CHECK(hits > 100);
  CHECK(near > 500);
}

TEST_CASE("a closed piece has no rim, and of an open one it is the border") {
  for (const bool is_open : {false, true}) {
    const TriangleMesh mesh = is_open ? hills(20) : icosphere(4, 1.0);
    const MeshPointer made = make_surface(mesh);
    const NodeRims rims(made->tree(), mesh.triangles);
    REQUIRE(rims.has_rim(0));
    CHECK(rims.rim(0).size() == (is_open ? 80u : 0u));
    CHECK(rims.end(0) - rims.begin(0) == static_cast<int>(mesh.triangles.size()));
  }
  const TriangleMesh soup = soup_of(hills(20));
  const MeshPointer made = make_surface(soup);
  CHECK(!NodeRims(made->tree(), soup.triangles).has_rim(0));
}
