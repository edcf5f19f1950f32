// Winding numbers of any surface, and the skin that follows them: held against sums of solid angles and formulas.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/geometry/inside.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"
#include "engine/geometry/mend/remesh.hpp"
#include "engine/geometry/mend/winding_tree.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

TriangleMesh two_balls(double apart) {
  TriangleMesh mesh = icosphere(4);
  const int first = static_cast<int>(mesh.vertices.size());
  const TriangleMesh other = icosphere(4);
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + Vec3(apart, 0.0, 0.0));
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

}  // namespace

TEST_CASE("winding numbers by dipoles are those of the sum of solid angles to 0.02, and decide alike") {
  TriangleMesh torn = bumpy_torus(40, 20);
  std::erase_if(torn.triangles, [](const Triangle& t) { return t[0] % 17 == 0; });
  for (const TriangleMesh& mesh : {bumpy_sphere(4), torn, two_balls(0.7), sheet(1.0, 12)}) {
    const WindingTree tree(mesh.triangles, mesh.vertices);
    Random random(5);
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = 1.6 * random.vector();
      const double exact = winding_number(x, mesh.vertices, mesh.triangles);
      REQUIRE(std::abs(tree.at(x) - exact) < 0.02);
      if (std::abs(exact - 0.5) > 0.02) REQUIRE(tree.is_inside(x) == (exact > 0.5));
    }
  }
}

TEST_CASE("a new skin is closed, crosses nothing, and its volume goes to the true one with the square of the cells") {
  const double exact = signed_volume(icosphere(5));
  double last = 0.0;
  for (const int cells : {16, 32, 64}) {
    double move = 0.0;
    const TriangleMesh skin = remesh(icosphere(5), {}, cells, &move);
    CHECK_FALSE(check_mesh(skin, make_topology(skin)));
    bool more = false;
    CHECK(find_crossings(skin, more).empty());
    CHECK(move < 0.2 * 2.0 / cells);
    const double error = std::abs(signed_volume(skin) / exact - 1.0);
    if (last > 0.0) CHECK(error < 0.4 * last);
    last = error;
  }
  CHECK(last < 1e-3);
}

TEST_CASE("of parts that overlap the skin is that of both together") {
  // two unit balls a apart: the lens they share has the volume pi (4 + a) (2 - a)^2 / 12
  const double a = 0.8, lens = M_PI * (4.0 + a) * (2.0 - a) * (2.0 - a) / 12.0;
  const double both = 2.0 * 4.0 / 3.0 * M_PI - lens;
  const TriangleMesh skin = remesh(two_balls(a), {}, 64, nullptr);
  CHECK_FALSE(check_mesh(skin, make_topology(skin)));
  bool more = false;
  CHECK(find_crossings(skin, more).empty());
  CHECK(signed_volume(skin) == Approx(both).epsilon(6e-3));
  int parts = measure(skin).components;
  CHECK(parts == 1);
}

TEST_CASE("a torn surface gets the skin of the whole one") {
  TriangleMesh torn = icosphere(4);
  std::erase_if(torn.triangles, [](const Triangle& t) { return t[0] % 23 == 0; });
  const TriangleMesh skin = remesh(torn, {}, 40, nullptr);
  CHECK_FALSE(check_mesh(skin, make_topology(skin)));
  CHECK(signed_volume(skin) == Approx(4.0 / 3.0 * M_PI).epsilon(0.03));
}

TEST_CASE("a skin is that of the outer of two surfaces that lie within a cell of each other") {
  TriangleMesh nested = icosphere(4);
  const TriangleMesh inner = icosphere(4, 0.98);  // a cell is 0.05
  append(nested, inner);
  const TriangleMesh skin = remesh(nested, {}, 40, nullptr);
  for (const Vec3& v : skin.vertices) REQUIRE(v.norm() == Approx(1.0).margin(5e-3));  // facets are 1e-3 within
}
