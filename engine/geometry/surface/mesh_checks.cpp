#include "engine/geometry/surface/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/surface/mesh_shells.hpp"

namespace impinge {
namespace {

/// "3 border edges", "1 border edge".
std::string counted(int count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// First edge with three or more triangles.
const MeshTopology::Edge* first_nonmanifold(const MeshTopology& topology) {
  const std::vector<int> uses = edge_uses(topology);
  for (std::size_t e = 0; e < uses.size(); ++e)
    if (uses[e] > 2) return &topology.edges[e];
  return nullptr;
}

}  // namespace

std::optional<std::string> check_indices(const TriangleMesh& mesh) {
  if (mesh.triangles.empty())
    return "has no triangles: a closed surface is needed; export faces, not only points or lines";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      return fmt::format(
          "has a vertex that is not finite: vertex {} is ({}, {}, {}); export it again or remove that vertex", v,
          mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z());
  const int count = static_cast<int>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (int v : t)
      if (v < 0 || v >= count)
        return fmt::format(
            "has an index out of range: triangle {} names vertex {}, allowed are 0 to {}; the file is damaged, export "
            "it again",
            i, v, count - 1);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      return fmt::format(
          "has a degenerate triangle: triangle {} has the corners {}, {} and {}; remove it or merge its neighbours' "
          "vertices",
          i, t[0], t[1], t[2]);
  }
  return std::nullopt;
}

std::optional<std::string> check_closed(const TriangleMesh& mesh, const MeshTopology& topology) {
  if (auto problem = check_indices(mesh)) return problem;
  if (topology.nonmanifold_edges > 0)
    if (const MeshTopology::Edge* edge = first_nonmanifold(topology))
      return fmt::format(
          "is not manifold: {} with three or more triangles, first between vertices {} and {}; "
          "separate the parts that meet there or remove inner walls",
          counted(topology.nonmanifold_edges, "edge"), edge->v0, edge->v1);
  if (topology.border_edges > 0)
    for (const MeshTopology::Edge& edge : topology.edges)
      if (edge.triangle1 < 0)
        return fmt::format(
            "is not closed: {}, first between vertices {} and {}; fill the holes or merge vertices that lie close "
            "together",
            counted(topology.border_edges, "border edge"), edge.v0, edge.v1);
  if (topology.misoriented_edges > 0)
    for (const MeshTopology::Edge& edge : topology.edges) {
      if (edge.triangle1 < 0) continue;
      if (runs_along(mesh.triangles[edge.triangle0], edge.v0, edge.v1) ==
          runs_along(mesh.triangles[edge.triangle1], edge.v0, edge.v1))
        return fmt::format(
            "is not oriented: neighbouring triangles face opposite ways across {}, first triangles {} and {} "
            "at vertices {} and {}; make the normals consistent",
            counted(topology.misoriented_edges, "edge"), edge.triangle0, edge.triangle1, edge.v0, edge.v1);
    }
  return std::nullopt;
}

std::optional<std::string> check_mesh(const TriangleMesh& mesh, const MeshTopology& topology) {
  if (auto problem = check_closed(mesh, topology)) return problem;
  if (auto problem = check_shells(mesh, topology)) return problem;
  if (!(signed_volume(mesh) > 0.0)) return "encloses no volume: it is flat; give it a thickness";
  return std::nullopt;
}

WeldedMesh weld(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto& x = mesh.vertices;
  // a NaN equals nothing and would spoil the order: such a vertex sorts by its index behind all finite ones
  const auto finite = [&](int v) { return x[v].allFinite(); };
  std::sort(order.begin(), order.end(), [&](int l, int r) {
    if (finite(l) != finite(r)) return finite(l);
    if (finite(l))
      for (int k = 0; k < 3; ++k)
        if (x[l][k] != x[r][k]) return x[l][k] < x[r][k];
    return l < r;
  });
  std::vector<int> first(count);
  for (int i = 0; i < count; ++i) {
    const bool same = i > 0 && finite(order[i]) && x[order[i]] == x[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }

  WeldedMesh welded;
  welded.new_vertex.assign(count, -1);
  for (int v = 0; v < count; ++v) {
    if (first[v] == v) {
      welded.new_vertex[v] = static_cast<int>(welded.mesh.vertices.size());
      welded.mesh.vertices.push_back(x[v]);
    } else {
      welded.new_vertex[v] = welded.new_vertex[first[v]];
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle t = mesh.triangles[i];
    for (int& v : t) v = v >= 0 && v < count ? welded.new_vertex[v] : v;
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    welded.mesh.triangles.push_back(t);
    welded.old_triangle.push_back(static_cast<int>(i));
  }
  return welded;
}

}  // namespace impinge
