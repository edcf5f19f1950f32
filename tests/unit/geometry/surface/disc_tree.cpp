#include "engine/geometry/surface/disc_tree.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "engine/geometry/surface/disc_walk.hpp"
#include "engine/geometry/surface/fitted_discs.hpp"
#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Checks that every disc holds the triangles below it; returns which those are.
std::vector<int> check_holds(const DiscTree& tree, const TriangleMesh& mesh, const std::vector<Vec3>& places, int level,
                             int j, int k) {
  std::vector<int> own;
  if (level + 1 == tree.levels()) {
    own.push_back(tree.order()[4 * j + k]);
  } else {
    for (int m = 0; m < tree.disc_count(level + 1, 4 * j + k); ++m)
      for (const int t : check_holds(tree, mesh, places, level + 1, 4 * j + k, m)) own.push_back(t);
  }
  const DiscTree::Node& node = tree.node(level, j);
  const auto at = [&](const float(&rows)[3][4]) { return Vec3(rows[0][k], rows[1][k], rows[2][k]); };
  int out = 0;
  for (const int t : own)
    for (const int v : mesh.triangles[t]) {
      const Vec3 arm = places[v] - tree.origin() - at(node.center);
      out += arm.norm() > node.radius[k] || std::abs(arm.dot(at(node.normal))) > node.thickness[k] ||
             (arm.cwiseAbs().array() > at(node.half).array()).any();
    }
  CHECK(out == 0);
  return own;
}

void check_all(const DiscTree& tree, const TriangleMesh& mesh, const std::vector<Vec3>& places) {
  std::multiset<int> seen;
  for (int k = 0; k < tree.disc_count(0, 0); ++k)
    for (const int t : check_holds(tree, mesh, places, 0, 0, k)) seen.insert(t);
  CHECK(seen.size() == mesh.triangles.size());
  CHECK(std::set<int>(seen.begin(), seen.end()).size() == mesh.triangles.size());
}

}  // namespace

TEST_CASE("discs hold every triangle once, at rest, fitted, far from the origin, and without area", "[disc_tree]") {
  for (const TriangleMesh& mesh : {bumpy_torus(30, 21), box(Vec3::Ones()), icosphere(3), icosphere(0)}) {
    DiscTree tree(mesh.triangles, mesh.vertices);
    check_all(tree, mesh, mesh.vertices);
    for (const double scale : {1.0, 1e-6, 1e4}) {
      std::vector<Vec3> moved = mesh.vertices;
      for (Vec3& x : moved) x = scale * Vec3(x.y() * x.y() + 1e3, 3.0 * x.x(), x.z() - x.x());
      tree.fit(mesh.triangles, moved);
      check_all(tree, mesh, moved);
    }
    const std::vector<Vec3> point(mesh.vertices.size(), Vec3(1, 2, 3));
    tree.fit(mesh.triangles, point);
    check_all(tree, mesh, point);
    std::vector<Vec3> line = mesh.vertices;
    for (Vec3& x : line) x = Vec3(x.x(), 0.0, 0.0);
    tree.fit(mesh.triangles, line);
    check_all(tree, mesh, line);
  }
  CHECK(DiscTree().triangle_count() == 0);
}

TEST_CASE("a tree with itself comes to every pair once", "[disc_tree]") {
  const TriangleMesh mesh = bumpy_torus(12, 9);
  const DiscTree tree(mesh.triangles, mesh.vertices);
  const DiscWalk walk(tree, tree, true, Pose(), 100.0);
  std::vector<DiscWalk::Task> waiting = {walk.start()};
  std::multiset<std::pair<int, int>> found;
  while (!waiting.empty()) {
    const DiscWalk::Task task = waiting.back();
    waiting.pop_back();
    walk.expand(task, waiting, [&](int i, int j) { found.insert(std::minmax(i, j)); });
  }
  const std::size_t n = mesh.triangles.size();
  CHECK(found.size() == n * (n - 1) / 2);
  CHECK(std::set<std::pair<int, int>>(found.begin(), found.end()).size() == found.size());
}

TEST_CASE("a tree of discs that has grown too large is made anew", "[disc_tree]") {
  const TriangleMesh mesh = icosphere(3);
  FittedDiscs fitted;
  fitted.fit(mesh.triangles, mesh.vertices);
  const std::vector<int> before = fitted.tree().order();
  std::vector<Vec3> moved = mesh.vertices;
  for (Vec3& x : moved) x *= 1.5;
  fitted.fit(mesh.triangles, moved);
  CHECK(fitted.tree().order() == before);
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = mesh.vertices[i * 101 % moved.size()];
  fitted.fit(mesh.triangles, moved);
  CHECK(fitted.tree().order() != before);
  check_all(fitted.tree(), mesh, moved);
}
