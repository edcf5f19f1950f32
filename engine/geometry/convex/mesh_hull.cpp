#include "engine/geometry/convex/mesh_hull.hpp"

#include <utility>

#include "engine/geometry/box_tree.hpp"

namespace impinge {

struct MeshHull::Search {
  Vec3 direction, size;  // and its absolute values
  double reach = -INFINITY;
  Vec3 point = Vec3::Zero();

  double bound(const Aabb& box) const { return direction.dot(box.center()) + 0.5 * size.dot(box.extent()); }
};

Vec3 MeshHull::support(const Vec3& direction) const {
  Search search{direction, direction.cwiseAbs()};
  visit(0, search);
  return search.point;
}

/// The half that may reach farther first: it leaves little of the other to look at.
void MeshHull::visit(int node, Search& search) const {
  const BoxTree& tree = surface_->tree();
  const BoxTree::Node& here = tree.nodes()[static_cast<std::size_t>(node)];
  for (int i = here.first; i < here.first + here.count; ++i) {
    const auto t = static_cast<std::size_t>(tree.order()[static_cast<std::size_t>(i)]);
    for (const int v : surface_->mesh.triangles[t]) {
      const Vec3& x = surface_->mesh.vertices[static_cast<std::size_t>(v)];
      if (const double reach = search.direction.dot(x); reach > search.reach) search.reach = reach, search.point = x;
    }
  }
  if (here.is_leaf()) return;
  const auto bound = [&](int n) { return search.bound(tree.nodes()[static_cast<std::size_t>(n)].box); };
  std::pair<double, int> first{bound(node + 1), node + 1}, second{bound(here.second), here.second};
  if (second.first > first.first) std::swap(first, second);
  for (const auto& [most, half] : {first, second})
    if (most > search.reach) visit(half, search);
}

}  // namespace impinge
