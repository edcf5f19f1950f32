// Proximity contacts: constraints between features that are close, before they overlap.
//
// A contact is a local minimum of the distance between the two surfaces, seen from a vertex (against a face, edge or
// vertex) or from two crossing edges. Each has a signed gap that is continuous as the surfaces touch and overlap a
// little. What is deeper than the search margin is pushed out along the shortest way that separates the intersecting
// triangles.
//
// Which minima are kept, and why nothing loses support by it:
// - a vertex-face contact is dropped if an edge of the vertex runs steeply (more than 30 degrees) towards the face: its
//   far end or the border of the face then carries the load; vertices of a face that tilts a little all stay, so that a
//   box that settles is caught by all its corners in one step;
// - a contact at a sharp edge or corner of the other surface stays only if it is a minimum seen from both sides.
//   (Otherwise a corner that stands a little past the rim of the body below it would be held by a sideways normal.)
//   Where it is none, the rim is closer to an inner point of the face, and gives its own contact from the other side.
#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"

namespace impinge {
namespace {

// relative to the mean edge: 1 micrometre for edges of 10 cm; what a solver leaves at rest is well below
constexpr double kTouch = 1e-5;

// of the smaller body's size: overlap that features still tell, where surfaces cross
constexpr double kDeep = 0.05;

double smallest_slope(const std::vector<Vec3>& rising, const std::vector<Vec3>& falling, const Vec3& n) {
  double smallest = 1.0;
  for (const Vec3& e : rising) smallest = std::min(smallest, e.dot(n));
  for (const Vec3& e : falling) smallest = std::min(smallest, -e.dot(n));
  return smallest;
}

// features that meet in one place (a corner above an edge's end) give one contact, not several equal rows; keeps the
// first
void drop_coincident(std::vector<Collision>& contacts, double distance) {
  std::vector<int> order(contacts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int l, int r) {
    return std::pair(contacts[l].point_a.x(), l) < std::pair(contacts[r].point_a.x(), r);
  });
  std::vector<char> is_dropped(contacts.size(), 0);
  InterruptPoll poll;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      poll();
      const Collision &l = contacts[order[i]], &r = contacts[order[j]];
      if (r.point_a.x() - l.point_a.x() > distance) break;
      if ((r.point_a - l.point_a).norm() <= distance && (r.point_b - l.point_b).norm() <= distance &&
          r.normal.dot(l.normal) > 1.0 - 1e-9)
        is_dropped[std::max(order[i], order[j])] = 1;
    }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (is_dropped[i] == 0) contacts[kept++] = contacts[i];
  contacts.resize(kept);
}

}  // namespace

std::pair<Vec3, double> separating_direction(const SurfaceView& a, const SurfaceFeature& fa, const SurfaceView& b,
                                             const SurfaceFeature& fb) {
  std::vector<Vec3> star_a, star_b, normals, candidates;
  a.star(fa, star_a);
  b.star(fb, star_b);
  b.adjacent_normals(fb, candidates);
  a.adjacent_normals(fa, normals);
  for (const Vec3& n : normals) candidates.push_back(-n);
  for (const Vec3& ea : star_a)
    for (const Vec3& eb : star_b) {
      const Vec3 cross = ea.cross(eb);
      const double length = cross.norm();
      if (length < 1e-3) continue;
      candidates.push_back(cross / length);
      candidates.push_back(-cross / length);
    }
  double best = -2.0;
  for (const Vec3& n : candidates)
    if (!n.isZero(0.0)) best = std::max(best, smallest_slope(star_a, star_b, n));
  // equals within rounding are averaged, so that no order of faces prefers one side of a symmetric corner
  Vec3 sum = Vec3::Zero();
  for (const Vec3& n : candidates)
    if (!n.isZero(0.0) && smallest_slope(star_a, star_b, n) >= best - 1e-9) sum += n;
  const double length = sum.norm();
  return length > 0.0 ? std::pair<Vec3, double>(sum / length, best) : std::pair<Vec3, double>(Vec3::Zero(), -1.0);
}

Collision exchanged(Collision c) {
  std::swap(c.body_a, c.body_b);
  std::swap(c.triangle_a, c.triangle_b);
  std::swap(c.point_a, c.point_b);
  c.normal = -c.normal;
  const std::uint64_t high = c.feature >> 32, low = c.feature & 0xffffffffu;
  c.feature = (low << 32) | high;  // kind and index of a feature fill one half each, in the same layout
  return c;
}

void keep_one_a_side(std::vector<Collision>& contacts) {
  const auto vertex = [](const Collision& c) -> std::uint64_t {  // of either body; 0: none
    const std::uint64_t high = c.feature >> 32, low = c.feature & 0xffffffffu;
    if (high >> 30 == static_cast<std::uint64_t>(Feature::vertex)) return 1 + 2 * high;
    return low >> 30 == static_cast<std::uint64_t>(Feature::vertex) ? 2 + 2 * low : 0;
  };
  std::sort(contacts.begin(), contacts.end(), [&](const Collision& l, const Collision& r) {
    const std::uint64_t vl = vertex(l), vr = vertex(r);
    return std::tuple(vl, std::abs(l.gap), l.feature) < std::tuple(vr, std::abs(r.gap), r.feature);
  });
  std::vector<Collision> kept;
  std::size_t first = 0;  // of the vertex at hand
  for (const Collision& c : contacts) {
    if (!kept.empty() && vertex(kept.back()) != vertex(c)) first = kept.size();
    const auto is_same_side = [&](const Collision& k) { return k.normal.dot(c.normal) > kSameSide; };
    if (vertex(c) == 0 || std::none_of(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(), is_same_side))
      kept.push_back(c);
  }
  contacts = std::move(kept);
  sort_by_feature(contacts);
}

void sort_by_feature(std::vector<Collision>& contacts) {
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Collision& l, const Collision& r) { return l.feature < r.feature; });
  const auto is_same = [](const Collision& l, const Collision& r) { return l.feature == r.feature; };
  contacts.erase(std::unique(contacts.begin(), contacts.end(), is_same), contacts.end());
}

void proximity_contacts(std::span<const Collider> colliders, const BodyPair& pair,
                        std::span<const TrianglePair> triangles, double activation, double time_step,
                        std::vector<Collision>& contacts) {
  if (triangles.empty()) return;
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  const bool crosses = any_crosses(triangles);
  const double touch = kTouch * std::min(a.mean_edge, b.mean_edge);
  const double deepest = crosses ? std::max(activation, kDeep * std::min(a.size, b.size)) : touch;
  const double margin = std::max({pair.margin, activation, deepest});
  const ProximityQuery query{SurfaceView(a, pair.a),
                             SurfaceView(b, pair.b),
                             triangles,
                             crosses,
                             margin,
                             deepest,
                             activation,
                             time_step,
                             touch};
  std::vector<Collision> found;
  append_vertex_contacts(query, found);
  append_edge_contacts(query, found);
  append_overlap_contacts(query, found);
  sort_by_feature(found);
  drop_coincident(found, query.touch);
  contacts.insert(contacts.end(), found.begin(), found.end());
}

}  // namespace impinge
