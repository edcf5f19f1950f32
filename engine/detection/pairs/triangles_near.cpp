#include "engine/detection/pairs/triangles_near.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {
namespace {

constexpr int kFewest = 64;  // triangles: below, looking at each is as quick

int count_of(const Collider& mesh) { return static_cast<int>(mesh.mesh().mesh.triangles.size()); }

bool deforms(const Collider& mesh) { return !mesh.vertex_velocities.empty(); }

/// A deforming surface has to be fitted first, which costs as much as looking at each triangle once.
bool has_tree(const Collider& mesh) { return count_of(mesh) > kFewest && (!deforms(mesh) || !mesh.node_boxes.empty()); }

/// What world coordinates lose on the way into the frame of the mesh, generously.
double slack(const Collider& mesh, const Aabb& box) {
  return 1e-12 * (largest_coordinate(box) + largest_coordinate(mesh.bounds));
}

/// Triangles in leaves whose boxes, and those above, `meets` says yes to; ascending.
template <class Meets>
std::vector<int> search(const Collider& mesh, Meets&& meets) {
  const BoxTree& tree = mesh.mesh().tree();
  std::vector<int> found;
  tree.search([&](int n) { return meets(deforms(mesh) ? mesh.node_boxes[n] : tree.nodes()[n].box); },
              [&](int t) { found.push_back(t); });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::vector<int> triangles_near(const Collider& mesh, const Aabb& box) {
  std::vector<int> near;
  const SurfaceView view(mesh, 0);
  const auto look = [&](int t) {
    if (overlap(triangle_bounds(view, t), box)) near.push_back(t);
  };
  if (box.is_empty() || !has_tree(mesh)) {
    for (int t = 0; t < count_of(mesh); ++t) look(t);
    return near;
  }
  // nodes are looked at in the world, where the bounds of a triangle are larger than in a rigid mesh's own frame
  const Mat3 turned = mesh.pose.rotation.cwiseAbs();
  const Aabb wide = box.inflated(slack(mesh, box));
  const auto meets = [&](const Aabb& node) {
    if (deforms(mesh)) return overlap(node, box);
    const Vec3 center = mesh.pose.apply(node.center()), half = product(turned, 0.5 * node.extent());
    return overlap(Aabb{center - half, center + half}, wide);
  };
  for (int t : search(mesh, meets)) look(t);
  return near;
}

std::vector<int> triangles_round(const Collider& mesh, const Vec3& x, double distance, bool and_nearest) {
  if (!has_tree(mesh)) {
    std::vector<int> all(static_cast<std::size_t>(count_of(mesh)));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const Vec3 local = deforms(mesh) ? x : mesh.pose.apply_inverse(x);
  double reach = distance;
  if (and_nearest) {
    const TriangleMesh& own = mesh.mesh().mesh;
    const std::span<const Vec3> places = deforms(mesh) ? mesh.vertices : std::span<const Vec3>(own.vertices);
    const NearestTriangle nearest = nearest_triangle(mesh.mesh().tree(), own.triangles, places, local, mesh.node_boxes);
    reach = std::max(reach, std::sqrt(nearest.at.squared_distance));
  }
  // the box's, whose corner is farther by rounding than the sphere's
  reach = reach * (1.0 + 1e-9) + slack(mesh, {x, x});
  return search(mesh, [&](const Aabb& node) { return squared_distance(node, local) <= reach * reach; });
}

}  // namespace impinge
