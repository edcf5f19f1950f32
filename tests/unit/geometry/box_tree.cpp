#include "engine/geometry/box_tree.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/support/geometry/meshes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void check_holds(const BoxTree& tree, const std::vector<Aabb>& boxes, const std::vector<Aabb>& fitted) {
  std::multiset<int> seen;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const BoxTree::Node& node = tree.nodes()[n];
    const auto holds = [&](const Aabb& inner) {
      CHECK((fitted[n].min.array() <= inner.min.array()).all());
      CHECK((fitted[n].max.array() >= inner.max.array()).all());
    };
    if (!node.is_leaf()) holds(fitted[n + 1]), holds(fitted[node.second]);
    for (int i = node.first; i < node.first + node.count; ++i)
      seen.insert(tree.order()[i]), holds(boxes[tree.order()[i]]);
  }
  CHECK(seen.size() == boxes.size());
  CHECK(std::set<int>(seen.begin(), seen.end()).size() == boxes.size());
}

}  // namespace

TEST_CASE("a box tree holds every triangle once, at rest and fitted to another shape", "[box_tree]") {
  for (const TriangleMesh& mesh : {bumpy_torus(30, 20), box(Vec3::Ones()), icosphere(3)}) {
    const std::vector<Aabb> boxes = triangle_boxes(mesh.triangles, mesh.vertices);
    const BoxTree tree(boxes);
    std::vector<Aabb> own;
    for (const BoxTree::Node& node : tree.nodes()) own.push_back(node.box);
    check_holds(tree, boxes, own);
    std::vector<Vec3> moved = mesh.vertices;
    for (Vec3& x : moved) x = Vec3(x.y() * x.y(), 3.0 * x.x(), x.z() - x.x());
    const std::vector<Aabb> moved_boxes = triangle_boxes(mesh.triangles, moved);
    std::vector<Aabb> fitted;
    tree.fit(moved_boxes, fitted);
    check_holds(tree, moved_boxes, fitted);
  }
  CHECK(BoxTree(std::vector<Aabb>{}).is_empty());
}

TEST_CASE("a box tree of equal boxes is as deep as one of different ones", "[box_tree]") {
  const std::vector<Aabb> boxes(4096, Aabb{Vec3::Zero(), Vec3::Ones()});
  const BoxTree tree(boxes, 1);
  std::vector<int> depth(tree.nodes().size(), 0);
  int deepest = 0;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    deepest = std::max(deepest, depth[n]);
    if (!tree.nodes()[n].is_leaf()) depth[n + 1] = depth[tree.nodes()[n].second] = depth[n] + 1;
  }
  CHECK(deepest == 12);
}
