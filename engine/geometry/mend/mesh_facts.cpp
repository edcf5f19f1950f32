#include "engine/geometry/mend/mesh_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/disjoint_sets.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/sheets.hpp"
#include "engine/geometry/ray_columns.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr int kMostCrossings = 64;      // of one triangle: a bundle of thousands would take the square of that
constexpr double kThinOfSize = 1e-3;    // of the longest side
constexpr double kFlatTriangle = 1e-9;  // height over the longest side

TriangleCorners corners_of(const TriangleMesh& mesh, int t) {
  const Triangle& v = mesh.triangles[t];
  return {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
}

bool share_a_vertex(const Triangle& a, const Triangle& b) {
  return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

/// Edges, vertices and what is wrong with them.
void count_topology(const TriangleMesh& mesh, const MeshTopology& topology, MeshFacts& facts, MeshMarks* marks) {
  facts.border_edges = topology.border_edges;
  facts.nonmanifold_edges = topology.nonmanifold_edges;
  facts.misoriented_edges = topology.misoriented_edges;
  facts.is_closed = topology.is_closed();
  label_parts(mesh, topology, facts.components);

  const std::vector<int> uses = edge_uses(topology);
  DisjointSets borders(mesh.vertices.size());
  std::vector<char> on_border(mesh.vertices.size(), 0);
  std::vector<double> lengths;
  for (std::size_t e = 0; e < uses.size(); ++e) {
    const MeshTopology::Edge& edge = topology.edges[e];
    lengths.push_back((mesh.vertices[edge.v1] - mesh.vertices[edge.v0]).norm());
    const std::pair ends(edge.v0, edge.v1);
    if (uses[e] == 1) {
      borders.join(edge.v0, edge.v1);
      on_border[edge.v0] = on_border[edge.v1] = 1;
      if (marks != nullptr) marks->border.push_back(ends);
    }
    if (uses[e] > 2 && marks != nullptr) marks->nonmanifold.push_back(ends);
    if (uses[e] == 2 && marks != nullptr &&
        runs_along(mesh.triangles[edge.triangle0], edge.v0, edge.v1) ==
            runs_along(mesh.triangles[edge.triangle1], edge.v0, edge.v1))
      marks->misoriented.push_back(ends);
  }
  for (int v = 0; v < static_cast<int>(on_border.size()); ++v)
    if (on_border[v] != 0 && borders.root(v) == v) ++facts.holes;
  if (!lengths.empty()) {
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    facts.median_edge = *middle;
    const auto [low, high] = std::minmax_element(lengths.begin(), lengths.end());
    facts.shortest_edge = *low;
    facts.longest_edge = *high;
  }
}

/// Vertices whose triangles are more than one fan, vertices without any, and handles.
void count_fans(const TriangleMesh& mesh, const MeshTopology& topology, MeshFacts& facts) {
  int used = 0;
  InterruptPoll poll;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    poll();
    const int begin = topology.vertex_triangle_begin[v], end = topology.vertex_triangle_begin[v + 1];
    if (begin == end) {
      ++facts.unused;
      continue;
    }
    ++used;
    facts.nonmanifold_vertices += fans_round(static_cast<int>(v), mesh, topology) > 1 ? 1 : 0;
  }
  if (facts.nonmanifold_edges > 0 || facts.nonmanifold_vertices > 0 || facts.misoriented_edges > 0) return;
  // vertices - edges + triangles = 2 parts - 2 handles - holes
  const long euler = used - static_cast<long>(topology.edges.size()) + static_cast<long>(mesh.triangles.size());
  const long twice = 2L * facts.components - facts.holes - euler;
  if (twice >= 0 && twice % 2 == 0) facts.genus = static_cast<int>(twice / 2);
}

void count_triangles(const TriangleMesh& mesh, MeshFacts& facts, MeshMarks* marks) {
  std::vector<Triangle> sorted;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    Triangle own = mesh.triangles[t];
    const TriangleCorners c = corners_of(mesh, t);
    const double twice_area = (c[1] - c[0]).cross(c[2] - c[0]).norm();
    const double longest_sq =
        std::max({(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
    facts.area += 0.5 * twice_area;
    for (const Vec3& x : c) facts.box.include(x);
    if (twice_area <= kFlatTriangle * longest_sq) {
      ++facts.degenerate;
      if (marks != nullptr) marks->degenerate.push_back(t);
    }
    std::sort(own.begin(), own.end());
    sorted.push_back(own);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) facts.duplicates += sorted[i] == sorted[i - 1] ? 1 : 0;
}

/// How thick the solid is behind each triangle, infinite where nothing lies behind it.
std::vector<double> find_thickness(const TriangleMesh& mesh, const BoxTree& tree) {
  std::vector<double> thickness(mesh.triangles.size(), std::numeric_limits<double>::infinity());
  parallel_for(thickness.size(), 64, [&](std::size_t i) {
    const TriangleCorners own = corners_of(mesh, static_cast<int>(i));
    const Vec3 normal = (own[1] - own[0]).cross(own[2] - own[0]);
    if (!(normal.norm() > 0.0)) return;
    const Vec3 start = (own[0] + own[1] + own[2]) / 3.0, inwards = -normal.normalized();
    double& nearest = thickness[i];
    const auto meets = [&](int n) {
      const Aabb& box = tree.nodes()[static_cast<std::size_t>(n)].box;
      double low = 0.0, high = nearest;
      for (int a = 0; a < 3; ++a) {
        if (inwards[a] == 0.0) {
          if (start[a] < box.min[a] || start[a] > box.max[a]) return false;
          continue;
        }
        const double p = (box.min[a] - start[a]) / inwards[a], q = (box.max[a] - start[a]) / inwards[a];
        low = std::max(low, std::min(p, q));
        high = std::min(high, std::max(p, q));
      }
      return low <= high;
    };
    tree.search(meets, [&](int t) {
      if (t == static_cast<int>(i)) return;
      const TriangleCorners other = corners_of(mesh, t);
      if ((other[1] - other[0]).cross(other[2] - other[0]).dot(inwards) <= 0.0) return;
      const auto hit = intersect_line(start, inwards, other);
      if (hit && hit->t >= 0.0) nearest = std::min(nearest, hit->t);
    });
  });
  return thickness;
}

}  // namespace

int fans_round(int vertex, const TriangleMesh& mesh, const MeshTopology& topology) {
  const int begin = topology.vertex_triangle_begin[vertex], end = topology.vertex_triangle_begin[vertex + 1];
  // triangles round the vertex are joined where they have another vertex in common
  std::vector<std::pair<int, int>> rays;  // other vertex, place
  for (int i = begin; i < end; ++i)
    for (const int w : mesh.triangles[topology.vertex_triangles[i]])
      if (w != vertex) rays.emplace_back(w, i - begin);
  std::sort(rays.begin(), rays.end());
  DisjointSets fans(static_cast<std::size_t>(end - begin));
  for (std::size_t i = 1; i < rays.size(); ++i)
    if (rays[i].first == rays[i - 1].first) fans.join(rays[i].second, rays[i - 1].second);
  int count = 0;
  for (int i = 0; i < end - begin; ++i) count += fans.root(i) == i ? 1 : 0;
  return count;
}

std::vector<std::pair<int, int>> find_crossings(const TriangleMesh& mesh, bool& more) {
  const BoxTree tree(triangle_boxes(mesh.triangles, mesh.vertices));
  std::vector<std::vector<int>> found(mesh.triangles.size());
  std::vector<char> is_full(mesh.triangles.size(), 0);
  parallel_for(found.size(), 64, [&](std::size_t i) {
    const int s = static_cast<int>(i);
    const TriangleCorners own = corners_of(mesh, s);
    const Aabb box = bounds_of(own[0], own[1], own[2]);
    tree.search([&](int n) { return is_full[i] == 0 && overlap(tree.nodes()[static_cast<std::size_t>(n)].box, box); },
                [&](int t) {
                  if (t <= s || is_full[i] != 0 || share_a_vertex(mesh.triangles[s], mesh.triangles[t])) return;
                  if (!triangles_intersect(own, corners_of(mesh, t))) return;
                  found[i].push_back(t);
                  if (found[i].size() >= kMostCrossings) is_full[i] = 1;
                });
  });
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t s = 0; s < found.size(); ++s) {
    std::sort(found[s].begin(), found[s].end());
    for (const int t : found[s]) pairs.emplace_back(static_cast<int>(s), t);
    more |= is_full[s] != 0;
  }
  return pairs;
}

MeshFacts measure(const TriangleMesh& given, MeshMarks* marks) {
  MeshFacts facts;
  TriangleMesh mesh = given;
  // triangles that name a vertex twice are counted, and left out of what can't take them
  const auto collapsed =
      std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  WeldedMesh welded = weld(mesh);
  facts.coinciding = static_cast<int>(mesh.vertices.size() - welded.mesh.vertices.size());
  // a surface that is closed as it stands keeps vertices that touch apart
  if (facts.coinciding > 0 && !make_topology(mesh).is_closed()) mesh = std::move(welded.mesh);
  facts.degenerate = static_cast<int>(given.triangles.size() - mesh.triangles.size());
  facts.vertices = mesh.vertices.size();
  facts.triangles = given.triangles.size();
  if (collapsed > 0) facts.problem = check_indices(given);
  if (mesh.triangles.empty()) {
    if (!facts.problem) facts.problem = check_indices(mesh);
    return facts;
  }
  const MeshTopology topology = make_topology(mesh);
  count_triangles(mesh, facts, marks);
  count_topology(mesh, topology, facts, marks);
  count_fans(mesh, topology, facts);
  facts.volume = signed_volume(mesh);
  const auto pairs = find_crossings(mesh, facts.more_crossings);
  facts.crossings = pairs.size();
  if (facts.is_closed) {
    const std::vector<double> thickness = find_thickness(mesh, BoxTree(triangle_boxes(mesh.triangles, mesh.vertices)));
    const double thin = kThinOfSize * facts.box.extent().maxCoeff();
    for (std::size_t t = 0; t < thickness.size(); ++t) {
      if (!std::isfinite(thickness[t])) continue;
      facts.thinnest = std::min(facts.thinnest.value_or(thickness[t]), thickness[t]);
      if (thickness[t] >= thin) continue;
      ++facts.thin;
      if (marks != nullptr) marks->thin.push_back(static_cast<int>(t));
    }
  }
  if (!facts.problem) facts.problem = check_mesh(mesh, topology);
  if (marks == nullptr) return facts;
  for (const auto& [s, t] : pairs) marks->crossing.push_back(s), marks->crossing.push_back(t);
  std::sort(marks->crossing.begin(), marks->crossing.end());
  marks->crossing.erase(std::unique(marks->crossing.begin(), marks->crossing.end()), marks->crossing.end());
  marks->mesh = std::move(mesh);
  return facts;
}

std::optional<double> enclosed_volume(const TriangleMesh& mesh) {
  constexpr double kRays = 200.0;
  const TriangleMesh welded = weld(mesh).mesh;
  if (welded.triangles.empty() || !make_topology(welded).is_closed()) return std::nullopt;
  Aabb box;
  for (const Vec3& p : welded.vertices) box.include(p);
  const double spacing = box.extent().maxCoeff() / kRays;
  if (!(spacing > 0.0)) return std::nullopt;
  int axis = 0;
  box.extent().minCoeff(&axis);  // along which rays are fewest crossings apart, and most of them meet it
  const RayColumns rays(welded, axis, spacing);
  const auto [i0, i1] = rays.u_range(box.min[rays.u_axis()], box.max[rays.u_axis()]);
  const auto [j0, j1] = rays.v_range(box.min[rays.v_axis()], box.max[rays.v_axis()]);
  double length = 0.0;
  for (int j = j0; j < j1; ++j)
    for (int i = i0; i < i1; ++i)
      for (const RayColumns::Interval& inside : rays.inside(i, j)) length += inside.high - inside.low;
  return length * spacing * spacing;
}

}  // namespace impinge
