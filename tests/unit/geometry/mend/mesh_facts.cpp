// What is said of a surface, held against what formulas say of it.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/geometry/mend/mesh_facts.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("size, volume, area, handles, edges and thickness of a box, a torus and a shell") {
  MeshFacts facts = measure(box({0.5, 1.0, 1.5}, {2, 2, 2}));
  CHECK(facts.box.extent() == Vec3(1.0, 2.0, 3.0));
  CHECK(facts.volume == Approx(6.0));
  CHECK(facts.area == Approx(2.0 * (2.0 + 3.0 + 6.0)));
  CHECK(facts.is_closed);
  CHECK(facts.genus == 0);
  CHECK(facts.components == 1);
  CHECK(facts.shortest_edge == Approx(0.5));
  CHECK(facts.longest_edge == Approx(std::hypot(1.0, 1.5)));
  CHECK(facts.thinnest.value() == Approx(1.0));
  CHECK(facts.crossings == 0);
  CHECK_FALSE(facts.problem);

  facts = measure(torus(1.0, 0.25, 60, 30));
  CHECK(facts.genus == 1);
  CHECK(facts.volume == Approx(2.0 * M_PI * M_PI * 0.25 * 0.25).epsilon(0.02));
  CHECK(facts.thinnest.value() == Approx(0.5).epsilon(0.03));

  // a ball with a wall of 1/5000
  TriangleMesh shell = icosphere(3);
  TriangleMesh inner = icosphere(3, 1.0 - 2e-4);
  for (const Triangle& t : inner.triangles)
    shell.triangles.push_back({t[0] + static_cast<int>(shell.vertices.size()),
                               t[2] + static_cast<int>(shell.vertices.size()),
                               t[1] + static_cast<int>(shell.vertices.size())});
  shell.vertices.insert(shell.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  facts = measure(shell);
  CHECK(facts.components == 2);
  CHECK(facts.thinnest.value() == Approx(2e-4).epsilon(0.05));
  CHECK(facts.thin >= 1280);
}

TEST_CASE("every fault is counted and marked where it is") {
  TriangleMesh mesh = box(Vec3::Constant(0.5));
  const Triangle gone = mesh.triangles.back();
  mesh.triangles.pop_back();
  MeshMarks marks;
  MeshFacts facts = measure(mesh, &marks);
  CHECK(facts.border_edges == 3);
  CHECK(facts.holes == 1);
  CHECK_FALSE(facts.is_closed);
  CHECK(marks.border.size() == 3);
  REQUIRE(facts.problem);
  CHECK(facts.problem->find("3 border edges") != std::string::npos);

  mesh.triangles.push_back({gone[0], gone[2], gone[1]});
  facts = measure(mesh, &(marks = {}));
  CHECK(facts.misoriented_edges == 3);
  CHECK(marks.misoriented.size() == 3);
  CHECK_FALSE(facts.genus);

  mesh.triangles.back() = gone;
  mesh.triangles.push_back({gone[0], gone[1], gone[1]});
  mesh.triangles.push_back(gone);
  facts = measure(mesh, &(marks = {}));
  CHECK(facts.degenerate == 1);
  CHECK(facts.duplicates == 1);
  CHECK(facts.nonmanifold_edges == 3);
  CHECK(marks.nonmanifold.size() == 3);

  // two boxes that pierce each other, and two that meet in a vertex
  TriangleMesh two = box(Vec3::Constant(0.5));
  for (const Vec3& v : box(Vec3::Constant(0.5)).vertices) two.vertices.push_back(v + Vec3(0.3, 0.2, 0.1));
  for (const Triangle& t : box(Vec3::Constant(0.5)).triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  facts = measure(two, &(marks = {}));
  CHECK(facts.crossings >= 6);
  CHECK(marks.crossing.size() >= 6);
  for (std::size_t v = 8; v < 16; ++v) two.vertices[v] = two.vertices[v - 8] + Vec3::Ones();
  two.triangles.pop_back();  // open, so that coinciding vertices are one
  CHECK(measure(two).nonmanifold_vertices == 1);
}
