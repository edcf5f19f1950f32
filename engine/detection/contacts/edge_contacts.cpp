// Proximity contacts of crossing edges: pairs whose closest points are inside both edges and a local minimum of
// distance.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/edge_cone.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"

namespace impinge {
namespace {

std::vector<EdgeCone> convex_edges(const SurfaceView& view, std::vector<int> triangles) {
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  std::vector<int> indices;
  for (int t : triangles)
    for (int e : view.triangle_edges(t)) indices.push_back(e);
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<EdgeCone> edges;
  for (int e : indices)
    if (const std::optional<EdgeCone> cone = make_edge_cone(view, e)) edges.push_back(*cone);
  return edges;
}

/// Places of a triangle's edges; -1 of one that is not there.
std::array<int, 3> places_of(const std::vector<EdgeCone>& edges, const std::array<int, 3>& indices) {
  std::array<int, 3> places{};
  for (int k = 0; k < 3; ++k) {
    const auto it =
        std::lower_bound(edges.begin(), edges.end(), indices[k], [](const EdgeCone& l, int r) { return l.index < r; });
    places[k] = it != edges.end() && it->index == indices[k] ? static_cast<int>(it - edges.begin()) : -1;
  }
  return places;
}

void add_contact(const ProximityQuery& query, const EdgeCone& ea, const EdgeCone& eb,
                 std::vector<Collision>& contacts) {
  const Vec3 da = ea.q - ea.p, db = eb.q - eb.p;
  // farther apart than their half lengths and the margin together: the cheap way to drop most pairs
  const double reach = 0.5 * (std::sqrt(da.squaredNorm()) + std::sqrt(db.squaredNorm())) + query.margin;
  if ((0.5 * (ea.p + ea.q) - 0.5 * (eb.p + eb.q)).squaredNorm() > reach * reach * (1.0 + 1e-9)) return;
  const std::optional<Vec3> outward = common_normal(ea, eb);
  if (!outward) return;
  const Vec3& normal = *outward;
  const SegmentSegment closest = closest_between_segments(ea.p, ea.q, eb.p, eb.q);
  if (!closest.interior || !(closest.squared_distance <= query.margin * query.margin)) return;
  const double gap = normal.dot(closest.point0 - closest.point1);
  if (gap < -query.deepest) return;  // of the far side of what is thin

  const int ta = query.a.edge(ea.index).triangle0, tb = query.b.edge(eb.index).triangle0;
  const Vec3 path =
      query.time_step * (query.a.velocity_at(ta, closest.point0) - query.b.velocity_at(tb, closest.point1));
  const double falls = -normal.dot(path);
  const bool would_cross = gap > 0.0 && falls > gap;
  if (gap > query.activation && !would_cross) return;
  if (would_cross && gap > query.touch) {
    // at the moment the edges' lines meet, do the edges? (Those that touch do; half of a gap of rounding is none.)
    const Vec3 shift = (gap / falls) * path;
    const double limit = std::min(0.5 * gap, query.activation);
    if (closest_between_segments(ea.p + shift, ea.q + shift, eb.p, eb.q).squared_distance > limit * limit) return;
  }
  Collision c;
  c.body_a = BodyIndex(query.a.body());
  c.body_b = BodyIndex(query.b.body());
  c.triangle_a = TriangleIndex(ta);
  c.triangle_b = TriangleIndex(tb);
  c.point_a = closest.point0;
  c.point_b = closest.point1;
  c.normal = normal;
  c.gap = gap;
  c.feature = feature_key(Feature::edge, ea.index, Feature::edge, eb.index);
  contacts.push_back(c);
}

}  // namespace

void append_edge_contacts(const ProximityQuery& query, std::vector<Collision>& contacts) {
  std::vector<int> triangles_a, triangles_b;
  for (const TrianglePair& pair : query.triangles) {
    triangles_a.push_back(pair.triangle_a);
    triangles_b.push_back(pair.triangle_b);
  }
  const std::vector<EdgeCone> edges_a = convex_edges(query.a, std::move(triangles_a));
  const std::vector<EdgeCone> edges_b = convex_edges(query.b, std::move(triangles_b));
  if (edges_a.empty() || edges_b.empty()) return;
  InterruptPoll poll;
  std::vector<std::pair<int, int>> met;  // edges of A and B; those that triangles share come several times
  std::vector<std::size_t> end(edges_a.size() + 1, 0);
  TriangleIndex last_a(-1);
  std::array<int, 3> of_a{};
  for (const TrianglePair& pair : query.triangles) {
    poll();
    if (pair.triangle_a != last_a) of_a = places_of(edges_a, query.a.triangle_edges(pair.triangle_a));
    last_a = pair.triangle_a;
    const std::array<int, 3> of_b = places_of(edges_b, query.b.triangle_edges(pair.triangle_b));
    for (const int i : of_a)
      for (const int j : of_b)
        if (i >= 0 && j >= 0) met.emplace_back(i, j), ++end[static_cast<std::size_t>(i) + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<int> with(met.size());  // the edges of B, by that of A
  for (const auto& [i, j] : met) with[end[static_cast<std::size_t>(i)]++] = j;
  for (std::size_t i = 0, first = 0; i < edges_a.size(); first = end[i++]) {
    poll();
    const auto begin = with.begin() + static_cast<std::ptrdiff_t>(first);
    const auto last = with.begin() + static_cast<std::ptrdiff_t>(end[i]);
    std::sort(begin, last);
    std::for_each(begin, std::unique(begin, last),
                  [&](int j) { add_contact(query, edges_a[i], edges_b[j], contacts); });
  }
}

}  // namespace impinge
