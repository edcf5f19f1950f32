#include "engine/geometry/mend/clean_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/mend/collapsing_surface.hpp"

namespace impinge {
namespace {

// height of a triangle over its longest side below which it is a line: rounding of single precision is 6e-8
constexpr double kFlat = 1e-9;

bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Cells of a grid, by a mixed number of their place.
std::uint64_t cell_key(const Vec3& x, double cell, int dx, int dy, int dz) {
  const auto part = [&](double value, int d) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / cell)) + d);
  };
  return part(x.x(), dx) * 0x9e3779b97f4a7c15ull ^ part(x.y(), dy) * 0xc2b2ae3d27d4eb4full ^
         part(x.z(), dz) * 0x165667b19e3779f9ull;
}

std::vector<char> border_vertices(const TriangleMesh& mesh) {
  std::vector<char> on_border(mesh.vertices.size(), 0);
  const MeshTopology topology = make_topology(mesh);
  for (const MeshTopology::Edge& edge : topology.edges)
    if (edge.triangle1 < 0) on_border[edge.v0] = on_border[edge.v1] = 1;
  return on_border;
}

bool same_way_round(const Triangle& a, const Triangle& b) {
  for (int k = 0; k < 3; ++k)
    if (a[0] == b[k]) return a[1] == b[(k + 1) % 3];
  return false;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// By edge of the topology, how many triangles of different corners have it.
std::vector<int> different_uses(const MeshTopology& topology, const std::vector<int>& first_alike) {
  std::vector<int> uses(topology.edges.size(), 0);
  for (std::size_t t = 0; t < topology.triangle_edges.size(); ++t)
    if (first_alike[t] == static_cast<int>(t))
      for (const int e : topology.triangle_edges[t]) ++uses[e];
  return uses;
}

/// The corner whose opposite side is the longest, where the triangle is a line; −1 where it is none.
int flat_corner(const TriangleMesh& mesh, const Triangle& t) {
  int corner = 0;
  double longest_sq = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double sq = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[(k + 2) % 3]]).squaredNorm();
    if (sq > longest_sq) longest_sq = sq, corner = k;
  }
  const Vec3& a = mesh.vertices[t[0]];
  const double twice_area = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  return twice_area <= kFlat * longest_sq ? corner : -1;
}

}  // namespace

int drop_collapsed(TriangleMesh& mesh) {
  return static_cast<int>(std::erase_if(mesh.triangles, [](const Triangle& t) { return is_collapsed(t); }));
}

BorderWeld weld_borders(TriangleMesh& mesh, double tolerance) {
  BorderWeld done;
  if (!(tolerance > 0.0)) return done;
  const std::vector<char> on_border = border_vertices(mesh);
  std::unordered_map<std::uint64_t, std::vector<int>> kept;  // by cell; only looked up
  std::vector<int> target(mesh.vertices.size());
  InterruptPoll poll;
  for (int v = 0; v < static_cast<int>(target.size()); ++v) {
    poll();
    target[v] = v;
    if (on_border[v] == 0) continue;
    const Vec3& x = mesh.vertices[v];
    double nearest_sq = tolerance * tolerance;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = kept.find(cell_key(x, tolerance, dx, dy, dz));
          if (cell == kept.end()) continue;
          for (const int other : cell->second) {
            const double sq = (mesh.vertices[other] - x).squaredNorm();
            if (sq < nearest_sq || (sq == nearest_sq && (target[v] == v || other < target[v])))
              nearest_sq = sq, target[v] = other;
          }
        }
    if (target[v] == v) {
      kept[cell_key(x, tolerance, 0, 0, 0)].push_back(v);
    } else {
      ++done.welded;
      done.largest_move = std::max(done.largest_move, std::sqrt(nearest_sq));
    }
  }
  if (done.welded == 0) return done;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = target[v];
  done.collapsed = drop_collapsed(mesh);
  return done;
}

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const int shift = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Triangle& t : part.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

double closing_tolerance(const TriangleMesh& mesh, double least) {
  constexpr int kTries = 6;  // thrice as far each, about
  const auto border_edges = [&](double tolerance) {
    TriangleMesh tried = mesh;
    const bool takes_any = weld_borders(tried, tolerance).collapsed > 0 && tolerance > least;
    return takes_any ? std::numeric_limits<int>::max() : static_cast<int>(make_topology(tried).border_edges);
  };
  int fewest = border_edges(least);
  double best = least, tolerance = least;
  for (int i = 0, half = fewest / 2; i < kTries && fewest > 0; ++i) {
    tolerance *= std::sqrt(10.0);
    if (const int left = border_edges(tolerance); left < std::min(fewest, half)) fewest = left, best = tolerance;
  }
  return best;
}

int drop_duplicates(TriangleMesh& mesh) {
  std::vector<int> order(mesh.triangles.size()), first_alike(mesh.triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::vector<Triangle> corners;
  for (const Triangle& t : mesh.triangles) corners.push_back(sorted(t));
  std::sort(order.begin(), order.end(),
            [&](int l, int r) { return std::tie(corners[l], l) < std::tie(corners[r], r); });
  bool any = false;
  std::vector<int> balance(order.size(), 0);  // of the first of each set: those that run its way, less the others
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int t = order[i];
    const bool is_copy = i > 0 && corners[order[i - 1]] == corners[t];
    any |= is_copy;
    first_alike[t] = is_copy ? first_alike[order[i - 1]] : t;
    balance[first_alike[t]] += same_way_round(mesh.triangles[first_alike[t]], mesh.triangles[t]) ? 1 : -1;
  }
  if (!any) return 0;
  const MeshTopology topology = make_topology(mesh);
  const std::vector<int> uses = different_uses(topology, first_alike);
  std::vector<Triangle> left;
  for (std::size_t t = 0; t < first_alike.size(); ++t) {
    if (first_alike[t] != static_cast<int>(t)) continue;
    const auto& edges = topology.triangle_edges[t];
    const bool is_between = std::any_of(edges.begin(), edges.end(), [&](int e) { return uses[e] > 2; });
    if (balance[t] == 0 && is_between) continue;
    left.push_back(mesh.triangles[t]);
  }
  const int dropped = static_cast<int>(mesh.triangles.size() - left.size());
  mesh.triangles = std::move(left);
  return dropped;
}

int join_coincident(TriangleMesh& mesh) {
  const auto has_no_length = [&](const Triangle& t, int k) {
    return mesh.vertices[t[k]] == mesh.vertices[t[(k + 1) % 3]];
  };
  const auto is_needle = [&](const Triangle& t) {
    return has_no_length(t, 0) || has_no_length(t, 1) || has_no_length(t, 2);
  };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), is_needle)) return 0;
  CollapsingSurface surface(mesh);
  int joined = 0;
  for (int a = 0; a < surface.vertex_count(); ++a) {
    const auto same = [&](int b) { return surface.vertices()[a] == surface.vertices()[b] && surface.may_join(a, b); };
    for (;;) {
      const std::vector<int> near = surface.neighbours(a);
      const auto b = std::find_if(near.begin(), near.end(), same);
      if (b == near.end()) break;
      surface.join(a, *b, surface.vertices()[a], surface.ring(a, *b));
      ++joined;
    }
  }
  if (joined > 0) mesh = surface.mesh();
  return joined;
}

int flip_flat(TriangleMesh& mesh) {
  std::vector<int> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (flat_corner(mesh, mesh.triangles[t]) >= 0) flat.push_back(static_cast<int>(t));
  if (flat.empty()) return 0;
  const MeshTopology topology = make_topology(mesh);
  const std::vector<int> uses = edge_uses(topology);
  const auto has_edge = [&](int a, int b) {
    const MeshTopology::Edge wanted{std::min(a, b), std::max(a, b), -1, -1};
    const auto less = [](const MeshTopology::Edge& l, const MeshTopology::Edge& r) {
      return std::tie(l.v0, l.v1) < std::tie(r.v0, r.v1);
    };
    return std::binary_search(topology.edges.begin(), topology.edges.end(), wanted, less);
  };
  std::vector<char> changed(mesh.triangles.size(), 0);
  int flips = 0;
  for (const int t : flat) {
    const Triangle own = mesh.triangles[t];
    const int k = flat_corner(mesh, own);
    const int e = topology.triangle_edges[t][(k + 1) % 3];
    const MeshTopology::Edge& edge = topology.edges[e];
    if (changed[t] != 0 || uses[e] != 2) continue;
    const int other = edge.triangle0 == t ? edge.triangle1 : edge.triangle0;
    if (changed[other] != 0) continue;
    const int middle = own[k], from = own[(k + 1) % 3], to = own[(k + 2) % 3];
    const Triangle& across = mesh.triangles[other];
    int far = -1;
    for (const int v : across)
      if (v != from && v != to) far = v;
    // a neighbour that is a line too would give two of them again; an edge that is there already would become a third's
    if (far < 0 || far == middle || flat_corner(mesh, across) >= 0 || has_edge(middle, far)) continue;
    if (!runs_along(across, to, from)) continue;
    mesh.triangles[t] = {middle, from, far};
    mesh.triangles[other] = {middle, far, to};
    changed[t] = changed[other] = 1;
    ++flips;
  }
  return flips;
}

}  // namespace impinge
