#include "engine/geometry/surface/edges_inside.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/inside.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr int kSamples = 9;  // of a stretch, to begin with: a mesh's distance has several maxima
constexpr int kHalvings = 20;
constexpr double kSlack = 1e-9;  // an edge through one of the other's meets either triangle there

/// A part of an edge between two places where it meets the other surface, or ends.
struct Stretch {
  Vec3 p, q;
  double deepest = 0.0;  ///< distance of `place` from the surface, metres: the largest found, on whichever side
  Vec3 place = Vec3::Zero();
  Vec3 at(double t) const { return p + t * (q - p); }
};

/// Those that begin where an edge enters, or end where it leaves.
std::vector<Stretch> inner_stretches(std::vector<EdgeHit>& hits, std::span<const Vec3> vertices) {
  std::sort(hits.begin(), hits.end(), [](const EdgeHit& l, const EdgeHit& r) {
    return std::tuple(l.v0, l.v1, l.t, l.enters) < std::tuple(r.v0, r.v1, r.t, r.enters);
  });
  std::vector<Stretch> list;
  for (std::size_t first = 0, last = 0; first < hits.size(); first = last) {
    const Vec3 &x = vertices[hits[first].v0], &y = vertices[hits[first].v1];
    double from = 0.0;
    bool has_entered = false;
    for (; last < hits.size() && hits[last].v0 == hits[first].v0 && hits[last].v1 == hits[first].v1; ++last) {
      const EdgeHit& hit = hits[last];
      if (hit.t > from && (has_entered || !hit.enters)) list.push_back({x + from * (y - x), x + hit.t * (y - x)});
      has_entered = hit.enters || (has_entered && !(hit.t > from));
      from = hit.t;
    }
    if (has_entered) list.push_back({x + from * (y - x), y});
  }
  return list;
}

/// Finds the place of the stretch that is farthest from the surface. One of its ends is on it, so that no triangle farther
/// off than the stretch is long can be the nearest.
void measure(Stretch& s, const SearchedMesh& other) {
  const Aabb reach = Aabb{s.p.cwiseMin(s.q), s.p.cwiseMax(s.q)}.inflated((s.q - s.p).norm() * (1.0 + kSlack));
  std::vector<Triangle> near;
  for (const int t : other.triangles_near(reach)) near.push_back(other.triangles()[static_cast<std::size_t>(t)]);
  double at = 0.5, step = 1.0 / (kSamples + 1);
  const auto look = [&](double t) {
    const double d = distance_to_surface(s.at(t), other.vertices(), near);
    if (d > s.deepest) s.deepest = d, at = t;
  };
  for (int i = 1; i <= kSamples; ++i) look(i * step);
  for (int i = 0; i < kHalvings; ++i, step *= 0.5)
    for (const double t : {at - 0.5 * step, at + 0.5 * step}) look(t);
  s.place = s.at(at);
}

bool is_inside(const Vec3& x, const SearchedMesh& mesh) { return mesh.winding(x) > 0.5; }

/// Of a stretch whose deepest place is outside: it runs along a face, which it leaves without meeting anything.
double deepest_inner_sample(const Stretch& s, const SearchedMesh& other) {
  double deepest = 0.0;
  for (int i = 1; i <= kSamples; ++i)
    if (const Vec3 x = s.at(i / (kSamples + 1.0)); is_inside(x, other)) deepest = std::max(deepest, other.distance(x));
  return deepest;
}

}  // namespace

void add_edge_hits(const Triangle& own, std::span<const Vec3> vertices, const TriangleCorners& other,
                   std::vector<EdgeHit>& hits) {
  const Vec3 normal = (other[1] - other[0]).cross(other[2] - other[0]);
  for (int k = 0; k < 3; ++k) {
    const int v0 = std::min(own[k], own[(k + 1) % 3]), v1 = std::max(own[k], own[(k + 1) % 3]);
    const Vec3 along = vertices[v1] - vertices[v0];
    const std::optional<RayHit> hit = intersect_line(vertices[v0], along, other, kSlack);
    if (hit && hit->t > 0.0 && hit->t < 1.0) hits.push_back({v0, v1, hit->t, along.dot(normal) < 0.0});
  }
}

double deepest_of_edges(std::vector<EdgeHit> hits, std::span<const Vec3> vertices, const SearchedMesh& other,
                        double known) {
  std::vector<Stretch> list = inner_stretches(hits, vertices);
  // of its ends one is on the surface and the other as well, or a vertex no deeper than what is known
  std::erase_if(list, [&](const Stretch& s) { return (s.q - s.p).norm() <= known; });
  if (list.empty()) return known;
  parallel_for(list.size(), 8, [&](std::size_t i) {
    check_interrupt();
    measure(list[i], other);
  });
  std::stable_sort(list.begin(), list.end(), [](const Stretch& l, const Stretch& r) { return l.deepest > r.deepest; });
  for (const Stretch& s : list) {
    check_interrupt();
    if (s.deepest <= known) break;
    known = std::max(known, is_inside(s.place, other) ? s.deepest : deepest_inner_sample(s, other));
  }
  return known;
}

}  // namespace impinge
