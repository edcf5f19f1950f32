#include "engine/geometry/mend/collapsing_surface.hpp"

#include <algorithm>

#include "engine/geometry/mend/mesh_facts.hpp"

namespace impinge {
namespace {

bool names(const Triangle& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

}  // namespace

std::vector<int> CollapsingSurface::Ring::all() const {
  std::vector<int> both = kept;
  both.insert(both.end(), lost.begin(), lost.end());
  return both;
}

CollapsingSurface::CollapsingSurface(const TriangleMesh& mesh)
    : x_(mesh.vertices),
      triangles_(mesh.triangles),
      count_(static_cast<int>(mesh.triangles.size())),
      gone_(mesh.triangles.size(), 0),
      around_(mesh.vertices.size()),
      on_border_(mesh.vertices.size(), 0),
      is_fixed_(mesh.vertices.size(), 0),
      seen_(mesh.vertices.size(), 0) {
  for (int t = 0; t < count_; ++t)
    for (const int v : triangles_[t]) around_[v].push_back(t);
  const MeshTopology topology = make_topology(mesh);
  const std::vector<int> uses = edge_uses(topology);
  for (std::size_t e = 0; e < uses.size(); ++e) {
    const MeshTopology::Edge& edge = topology.edges[e];
    if (uses[e] == 1) on_border_[edge.v0] = on_border_[edge.v1] = 1;
    const bool is_torn = uses[e] > 2 || (uses[e] == 2 && runs_along(triangles_[edge.triangle0], edge.v0, edge.v1) ==
                                                             runs_along(triangles_[edge.triangle1], edge.v0, edge.v1));
    if (is_torn) is_fixed_[edge.v0] = is_fixed_[edge.v1] = 1;
  }
  for (int v = 0; v < vertex_count(); ++v)
    if (fans_round(v, mesh, topology) > 1) is_fixed_[v] = 1;
}

TriangleCorners CollapsingSurface::corners(int triangle) const {
  const Triangle& t = triangles_[triangle];
  return {x_[t[0]], x_[t[1]], x_[t[2]]};
}

std::vector<int> CollapsingSurface::neighbours(int vertex) {
  ++question_;
  std::vector<int> found;
  for (const int t : around_[vertex])
    for (const int w : triangles_[t])
      if (w != vertex && seen_[w] != question_) seen_[w] = question_, found.push_back(w);
  return found;
}

bool CollapsingSurface::may_join(int a, int b) {
  if (is_fixed_[a] != 0 || is_fixed_[b] != 0) return false;
  const auto across = static_cast<std::size_t>(
      std::count_if(around_[a].begin(), around_[a].end(), [&](int t) { return names(triangles_[t], b); }));
  if (across == 0 || (across == 2 && is_on_border(a) && is_on_border(b))) return false;
  const std::vector<int> of_b = neighbours(b), of_a = neighbours(a);
  const auto common =
      static_cast<std::size_t>(std::count_if(of_b.begin(), of_b.end(), [&](int w) { return seen_[w] == question_; }));
  // the ends have the corners across their edge in common and nothing else
  if (common != across) return false;
  const std::size_t round = of_a.size() + of_b.size() - 2 - common;
  return across == 2 ? round >= 3 : around_[a].size() + around_[b].size() > 2;
}

CollapsingSurface::Ring CollapsingSurface::ring(int a, int b) const {
  Ring ring;
  for (const int t : around_[a]) (names(triangles_[t], b) ? ring.lost : ring.kept).push_back(t);
  for (const int t : around_[b])
    if (!names(triangles_[t], a)) ring.kept.push_back(t);
  return ring;
}

void CollapsingSurface::join(int a, int b, const Vec3& x, const Ring& ring) {
  x_[a] = x;
  on_border_[a] |= on_border_[b];
  for (const int t : ring.lost) {
    gone_[t] = 1;
    --count_;
    for (const int v : triangles_[t]) std::erase(around_[v], t);
  }
  for (const int t : ring.kept)
    for (int& v : triangles_[t]) v = v == b ? a : v;
  around_[a] = ring.kept;
  around_[b].clear();
}

TriangleMesh CollapsingSurface::mesh() const {
  TriangleMesh mesh;
  std::vector<int> index(x_.size(), -1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (gone_[t] == 0)
      for (const int v : triangles_[t]) index[v] = 0;
  for (std::size_t v = 0; v < index.size(); ++v)
    if (index[v] == 0) index[v] = static_cast<int>(mesh.vertices.size()), mesh.vertices.push_back(x_[v]);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (const Triangle& own = triangles_[t]; gone_[t] == 0)
      mesh.triangles.push_back({index[own[0]], index[own[1]], index[own[2]]});
  return mesh;
}

}  // namespace impinge
