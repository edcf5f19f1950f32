#include "engine/geometry/triangle_mesh.hpp"

#include <algorithm>

#include "engine/geometry/box_tree.hpp"

namespace impinge {

MeshTopology make_topology(const TriangleMesh& mesh) {
  struct HalfEdge {
    int v0, v1, triangle, corner;
    bool forward;
  };
  std::vector<HalfEdge> halves;
  halves.reserve(mesh.triangles.size() * 3);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      halves.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.v0, l.v1, l.triangle, l.corner) < std::tie(r.v0, r.v1, r.triangle, r.corner);
  });

  MeshTopology topology;
  topology.triangle_edges.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < halves.size();) {
    std::size_t end = i;
    MeshTopology::Edge edge{halves[i].v0, halves[i].v1, -1, -1};
    const int index = static_cast<int>(topology.edges.size());
    for (; end < halves.size() && halves[end].v0 == edge.v0 && halves[end].v1 == edge.v1; ++end)
      topology.triangle_edges[halves[end].triangle][halves[end].corner] = index;
    edge.triangle0 = halves[i].triangle;
    if (end - i >= 2) edge.triangle1 = halves[i + 1].triangle;
    if (end - i == 1) ++topology.border_edges;
    if (end - i > 2) ++topology.nonmanifold_edges;
    if (end - i == 2 && halves[i].forward == halves[i + 1].forward) ++topology.misoriented_edges;
    topology.edges.push_back(edge);
    i = end;
  }

  std::vector<int>& begin = topology.vertex_triangle_begin;
  begin.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles)
    for (int v : t) ++begin[v + 1];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) begin[v + 1] += begin[v];
  topology.vertex_triangles.resize(mesh.triangles.size() * 3);
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int v : mesh.triangles[t]) topology.vertex_triangles[next[v]++] = t;
  return topology;
}

const BoxTree& SurfaceMesh::tree() const {
  return lazy_tree.get([&] { return BoxTree(triangle_boxes(mesh.triangles, mesh.vertices)); });
}

std::vector<int> edge_uses(const MeshTopology& topology) {
  std::vector<int> uses(topology.edges.size(), 0);
  for (const std::array<int, 3>& edges : topology.triangle_edges)
    for (const int e : edges) ++uses[e];
  return uses;
}

bool runs_along(const Triangle& triangle, int from, int to) {
  for (int k = 0; k < 3; ++k)
    if (triangle[k] == from && triangle[(k + 1) % 3] == to) return true;
  return false;
}

MeshPointer make_surface(TriangleMesh mesh) {
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = std::move(mesh);
  surface->topology = make_topology(surface->mesh);
  return surface;
}

double mean_edge_length(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) sum += (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
  return mesh.triangles.empty() ? 0.0 : sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace impinge
