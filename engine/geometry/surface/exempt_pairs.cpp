#include "engine/geometry/surface/exempt_pairs.hpp"

#include <algorithm>

#include "engine/core/parallel.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

std::uint64_t key_of(int s, int t) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::min(s, t))) << 32 |
         static_cast<std::uint32_t>(std::max(s, t));
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

}  // namespace

ExemptPairs::ExemptPairs(const SurfaceMesh& surface, double distance) {
  const TriangleMesh& mesh = surface.mesh;
  const BoxTree& tree = surface.tree();
  const auto corners = [&](int t) {
    const Triangle& v = mesh.triangles[t];
    return TriangleCorners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  };
  std::vector<std::vector<std::uint64_t>> found(mesh.triangles.size());  // by triangle, so that threads don't share
  parallel_for(found.size(), 64, [&](std::size_t i) {
    const int s = static_cast<int>(i);
    const TriangleCorners own = corners(s);
    const Aabb box = bounds_of(own[0], own[1], own[2]);
    const Aabb around = box.inflated(distance + 1e-12 * largest_coordinate(box));
    tree.search(
        [&](int n) { return overlap(tree.nodes()[static_cast<std::size_t>(n)].box, around); },
        [&](int t) {
          if (t <= s || share_a_vertex(mesh.triangles[s], mesh.triangles[t])) return;
          const TriangleCorners other = corners(t);
          if (triangles_intersect(own, other) || closest_features(own, other).squared_distance <= distance * distance)
            found[i].push_back(key_of(s, t));
        });
  });
  for (const std::vector<std::uint64_t>& of_triangle : found)
    pairs_.insert(pairs_.end(), of_triangle.begin(), of_triangle.end());
  std::sort(pairs_.begin(), pairs_.end());
}

bool ExemptPairs::has(int s, int t) const { return std::binary_search(pairs_.begin(), pairs_.end(), key_of(s, t)); }

bool ExemptPairs::has_vertex(const MeshTopology& topology, int vertex, int t) const {
  for (int i = topology.vertex_triangle_begin[vertex]; i < topology.vertex_triangle_begin[vertex + 1]; ++i)
    if (has(topology.vertex_triangles[i], t)) return true;
  return false;
}

bool ExemptPairs::has_edges(const MeshTopology& topology, int e, int f) const {
  const MeshTopology::Edge &a = topology.edges[e], &b = topology.edges[f];
  for (const int s : {a.triangle0, a.triangle1})
    for (const int t : {b.triangle0, b.triangle1})
      if (s >= 0 && t >= 0 && has(s, t)) return true;
  return false;
}

}  // namespace impinge
