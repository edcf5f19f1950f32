#include "engine/detection/pairs/nearest_features.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/pairs/primitive.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

constexpr int kDoublings = 200;      // of how far is looked: more than lengths of numbers have
constexpr double kFirstLook = 1e-3;  // of the smaller body's size

bool is_mesh(const Collider& c) { return c.shape->mesh() != nullptr; }

/// Where a point of a triangle lies on its mesh.
std::pair<Feature, int> feature_at(const Collider& mesh, int triangle, const Vec3& point) {
  const TriangleFeature f = closest_on_triangle(point, corners_of(mesh, triangle)).feature;
  if (is_corner(f)) return {Feature::vertex, mesh.mesh().mesh.triangles[triangle][feature_number(f)]};
  if (is_edge(f)) return {Feature::edge, mesh.mesh().topology.triangle_edges[triangle][feature_number(f)]};
  return {Feature::face, triangle};
}

/// The nearest features of triangles that are apart. The measure is the one by which the triangle search finds them.
NearestFeatures nearest_of(const Collider& a, const Collider& b, std::span<const TrianglePair> pairs) {
  NearestFeatures best;
  double least = INFINITY;
  InterruptPoll poll;
  for (const TrianglePair& pair : pairs) {
    poll();
    const TriangleTriangle t = closest_features(corners_of(a, pair.triangle_a), corners_of(b, pair.triangle_b));
    if (t.squared_distance >= least) continue;
    least = t.squared_distance;
    best.point_a = t.point0, best.point_b = t.point1;
    best.triangle_a = pair.triangle_a, best.triangle_b = pair.triangle_b;
  }
  best.distance = std::sqrt(least);
  if (best.distance > 0.0) best.normal = (best.point_a - best.point_b) / best.distance;
  std::tie(best.kind_a, best.index_a) = feature_at(a, best.triangle_a, best.point_a);
  std::tie(best.kind_b, best.index_b) = feature_at(b, best.triangle_b, best.point_b);
  return best;
}

const Collision* deepest(const std::vector<Collision>& contacts) {
  const auto it = std::min_element(contacts.begin(), contacts.end(),
                                   [](const Collision& l, const Collision& r) { return l.gap < r.gap; });
  return it == contacts.end() ? nullptr : &*it;
}

/// What one unit of distance is for a body, metres.
double size_of(const Collider& c) {
  const double size = c.bounds.extent().norm();
  return std::isfinite(size) ? size : INFINITY;
}

}  // namespace

double box_gap(const Aabb& a, const Aabb& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm(); }

NearestFeatures features_of(const Collision& contact) {
  const auto kind = [](std::uint64_t half) { return static_cast<Feature>(half >> 30 & 3u); };
  const auto index = [](std::uint64_t half) { return static_cast<int>(half & 0x3fffffffu); };
  const std::uint64_t high = contact.feature >> 32, low = contact.feature & 0xffffffffu;
  return {contact.gap,        contact.point_a, contact.point_b, contact.normal, contact.triangle_a,
          contact.triangle_b, kind(high),      kind(low),       index(high),    index(low)};
}

NearestSearch::NearestSearch() : triangles_(make_named(narrow_phases(), "bvh")) {}

std::optional<NearestFeatures> NearestSearch::within(std::span<const Collider> colliders, BodyPair pair) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  const ContactQuery query{true, pair.margin, 0.0};
  std::vector<Collision> contacts;
  if (!is_mesh(a) || !is_mesh(b)) {
    primitive_contacts(colliders, pair, query, contacts);
    const Collision* nearest = deepest(contacts);
    return nearest == nullptr ? std::nullopt : std::optional(features_of(*nearest));
  }
  std::vector<TrianglePair> found;
  triangles_->find(colliders, std::span(&pair, 1), found);
  if (found.empty()) return std::nullopt;
  if (std::none_of(found.begin(), found.end(), [](const TrianglePair& t) { return t.intersecting; }))
    return nearest_of(a, b, found);
  proximity_contacts(colliders, pair, found, pair.margin, 0.0, contacts);
  const Collision* nearest = deepest(contacts);
  if (nearest != nullptr && nearest->gap <= 0.0) return features_of(*nearest);
  NearestFeatures touching = nearest_of(a, b, found);  // surfaces that cross, with no contact to say how deep
  touching.distance = 0.0;
  return touching;
}

std::optional<NearestFeatures> NearestSearch::find(std::span<const Collider> colliders, BodyIndex a, BodyIndex b,
                                                   double limit) {
  if (a == b) return std::nullopt;
  const double gap = box_gap(colliders[a].bounds, colliders[b].bounds);
  const double size = std::min(size_of(colliders[a]), size_of(colliders[b]));
  if (gap > limit || !std::isfinite(size)) return std::nullopt;  // or two planes
  // farther and farther: what is far away is many triangles, and most of them are not the nearest
  double reach = gap + kFirstLook * size;
  for (int i = 0; i < kDoublings; ++i, reach *= 2.0) {
    check_interrupt();
    const double now = std::min(reach, limit);
    if (auto nearest = within(colliders, {a, b, now}); nearest && nearest->distance <= now) return nearest;
    if (now >= limit || !std::isfinite(now)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace impinge
