// What is left when surfaces cross deeper than the features tell: each intersecting triangle pair that no contact
// pushes apart is separated along the axis of least overlap of the two triangles (separating axes: two normals, nine
// edge pairs).
//
// The seed's contact, the deepest vertex behind the other triangle's plane [Haapaoja16 §3.2.3], is one of these axes.
// Where an edge merely clips a corner of a large triangle its depth is that of the far end of the edge; the least
// overlap is not.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/edge_cone.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"

namespace impinge {
namespace {

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  int low_corner = 0, high_corner = 0;
};

Interval project(const TriangleCorners& c, const Vec3& origin, const Vec3& axis) {
  Interval i;
  for (int k = 0; k < 3; ++k) {
    const double x = axis.dot(c[k] - origin);
    if (x < i.low) i.low = x, i.low_corner = k;
    if (x > i.high) i.high = x, i.high_corner = k;
  }
  return i;
}

class Separation {
 public:
  Separation(const ProximityQuery& query, const TrianglePair& pair)
      : query_(query), pair_(pair), a_(query.a.corners(pair.triangle_a)), b_(query.b.corners(pair.triangle_b)) {
    const Vec3 na = query.a.face_normal(pair.triangle_a), nb = query.b.face_normal(pair.triangle_b);
    depth_ = std::numeric_limits<double>::infinity();
    if (!nb.isZero(0.0)) try_face_of_b(nb);
    if (!na.isZero(0.0)) try_face_of_a(na);
    for (int k = 0; k < 3; ++k) {
      cones_a_[k] = make_edge_cone(query.a, query.a.triangle_edges(pair.triangle_a)[k]);
      cones_b_[k] = make_edge_cone(query.b, query.b.triangle_edges(pair.triangle_b)[k]);
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) try_edges(i, j);
  }
  bool is_found() const { return std::isfinite(depth_); }
  const Collision& contact() const { return best_; }

 private:
  void try_face_of_b(const Vec3& n) {
    const Interval i = project(a_, b_[0], n);
    if (!(-i.low < depth_)) return;
    depth_ = -i.low;
    const Vec3& x = a_[i.low_corner];
    set(x, closest_on_triangle(x - i.low * n, b_).point, n, query_.b.body(),
        {Feature::vertex, query_.a.triangle(pair_.triangle_a)[i.low_corner]}, {Feature::face, pair_.triangle_b});
  }

  void try_face_of_a(const Vec3& n) {
    const Interval i = project(b_, a_[0], n);
    if (!(-i.low < depth_)) return;
    depth_ = -i.low;
    const Vec3& x = b_[i.low_corner];
    set(closest_on_triangle(x - i.low * n, a_).point, x, -n, query_.a.body(), {Feature::face, pair_.triangle_a},
        {Feature::vertex, query_.b.triangle(pair_.triangle_b)[i.low_corner]});
  }

  void try_edges(int i, int j) {
    if (!cones_a_[i] || !cones_b_[j]) return;
    const std::optional<Vec3> outward = common_normal(*cones_a_[i], *cones_b_[j]);
    if (!outward) return;
    const Vec3& n = *outward;
    const Vec3 &p = a_[i], &q = a_[(i + 1) % 3], &r = b_[j], &s = b_[(j + 1) % 3];
    const Interval of_a = project(a_, r, n), of_b = project(b_, r, n);
    const double depth = of_b.high - of_a.low;
    if (!(depth < depth_)) return;
    // only if these two edges are the ones that touch last
    const double rounding = 1e-9 * std::max((q - p).norm(), (s - r).norm());
    if (n.dot(p - r) > of_a.low + rounding || of_b.high > rounding) return;
    depth_ = depth;
    const SegmentSegment closest = closest_between_segments(p, q, r, s);
    set(closest.point0, closest.point1, n, -1, {Feature::edge, cones_a_[i]->index},
        {Feature::edge, cones_b_[j]->index});
  }

  void set(const Vec3& point_a, const Vec3& point_b, const Vec3& n, int owner, SurfaceFeature fa, SurfaceFeature fb) {
    best_.body_a = pair_.a;
    best_.body_b = pair_.b;
    best_.triangle_a = TriangleIndex(query_.a.triangle_of(fa));
    best_.triangle_b = TriangleIndex(query_.b.triangle_of(fb));
    best_.point_a = point_a;
    best_.point_b = point_b;
    best_.normal = n;
    best_.gap = n.dot(point_a - point_b);
    best_.normal_owner = BodyIndex(owner);
    best_.feature = feature_key(fa.kind, fa.index, fb.kind, fb.index);
  }

  const ProximityQuery& query_;
  const TrianglePair& pair_;
  TriangleCorners a_, b_;
  std::array<std::optional<EdgeCone>, 3> cones_a_, cones_b_;
  double depth_ = 0.0;
  Collision best_;
};

// what is pushed out already: vertices of either body behind the other's surface, and edge pairs that overlap
class Pushed {
 public:
  void add(const Collision& c) {
    const FeaturePair features = features_of_key(c.feature);
    if (features.kind_a == Feature::vertex) of_a_.insert(features.index_a);
    if (features.kind_b == Feature::vertex) of_b_.insert(features.index_b);
    edges_.insert(c.feature);
  }
  bool covers(const ProximityQuery& query, const TrianglePair& pair) const {
    for (int v : query.a.triangle(pair.triangle_a))
      if (of_a_.contains(v)) return true;
    for (int v : query.b.triangle(pair.triangle_b))
      if (of_b_.contains(v)) return true;
    for (int ea : query.a.triangle_edges(pair.triangle_a))
      for (int eb : query.b.triangle_edges(pair.triangle_b))
        if (edges_.contains(feature_key(Feature::edge, ea, Feature::edge, eb))) return true;
    return false;
  }

 private:
  std::set<int> of_a_, of_b_;
  std::set<std::uint64_t> edges_;
};

}  // namespace

void append_overlap_contacts(const ProximityQuery& query, std::vector<Collision>& contacts) {
  if (!query.crosses) return;
  Pushed pushed;
  for (const Collision& c : contacts)
    if (c.gap <= query.touch) pushed.add(c);
  std::vector<std::pair<Collision, TrianglePair>> found, touching;
  bool is_any_pushed = std::any_of(contacts.begin(), contacts.end(), [](const Collision& c) { return c.gap < 0.0; });
  InterruptPoll poll;
  for (const TrianglePair& pair : query.triangles) {
    poll();
    if (!pair.intersecting || pushed.covers(query, pair)) continue;
    const Separation separation(query, pair);
    // triangles that merely touch need no push; sliding along each other they must not catch
    if (!separation.is_found() || separation.contact().gap >= -query.touch) continue;
    const double features =
        closest_features(query.a.corners(pair.triangle_a), query.b.corners(pair.triangle_b)).squared_distance;
    (features > query.touch * query.touch ? found : touching).emplace_back(separation.contact(), pair);
  }
  // What only touches (a corner exactly on a corner) pushes nothing out, however deep they cross beside it.
  const auto is_deep = [&](const Collision& c) { return c.gap < -query.touch; };
  if (found.empty() && std::none_of(contacts.begin(), contacts.end(), is_deep))
    for (const TrianglePair& pair : query.triangles) {
      poll();
      if (!pair.intersecting ||
          features_within(query.a.corners(pair.triangle_a), query.b.corners(pair.triangle_b), query.touch))
        continue;
      const Separation separation(query, pair);
      if (separation.is_found() && is_deep(separation.contact())) found.emplace_back(separation.contact(), pair);
    }
  // triangles that meet in a border only (bodies flush with each other) tell little about the way out: the last resort
  if (found.empty() && !is_any_pushed) found = std::move(touching);
  if (found.empty()) return;
  // the shallowest first: where it pushes a triangle, the much deeper ways to separate the same triangle are not taken
  std::stable_sort(found.begin(), found.end(), [](const auto& l, const auto& r) {
    return std::pair(-l.first.gap, l.first.feature) < std::pair(-r.first.gap, r.first.feature);
  });
  const double shallow = 2.0 * found.front().first.gap;
  std::vector<Collision> kept;
  for (const auto& [contact, pair] : found) {
    poll();
    if (contact.gap < shallow && pushed.covers(query, pair)) continue;
    pushed.add(contact);
    kept.push_back(contact);
  }
  keep_one_a_side(kept);
  contacts.insert(contacts.end(), kept.begin(), kept.end());
}

}  // namespace impinge
