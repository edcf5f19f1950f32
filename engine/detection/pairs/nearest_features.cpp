#include "engine/detection/pairs/nearest_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"
#include "engine/detection/pairs/primitive.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/shapes/faceted.hpp"

namespace impinge {
namespace {

constexpr int kDoublings = 200;      // of how far is looked: more than lengths of numbers have
constexpr double kFirstLook = 1e-3;  // of the smaller body's size
constexpr double kRounding = 1e-12;  // of both bodies' size

bool is_mesh(const Collider& c) { return c.shape->mesh() != nullptr; }

/// Where a point of a triangle lies on its mesh.
std::pair<Feature, int> feature_at(const Collider& mesh, int triangle, const Vec3& point) {
  const TriangleFeature f = closest_on_triangle(point, corners_of(mesh, triangle)).feature;
  if (is_corner(f)) return {Feature::vertex, mesh.mesh().mesh.triangles[triangle][feature_number(f)]};
  if (is_edge(f)) return {Feature::edge, mesh.mesh().topology.triangle_edges[triangle][feature_number(f)]};
  return {Feature::face, triangle};
}

/// Two trees of boxes from their roots, the nearer halves first; what can't be nearer than the nearest so far is left out.
class TreeSearch {
 public:
  TreeSearch(const Collider& a, const Collider& b) : sides_{Side(a), Side(b)} {}

  /// The two nearest triangles of surfaces that don't cross, none if they are not nearer than `limit`, metres.
  std::optional<TrianglePair> nearest(double limit) {
    least_ = limit * limit;
    if (!sides_[0].tree->is_empty() && !sides_[1].tree->is_empty()) visit(0, 0);
    return best_;
  }

 private:
  struct Side {
    explicit Side(const Collider& c) : of(&c), tree(&c.mesh().tree()) {
      tree->fit(triangle_boxes(c.mesh().mesh.triangles, c.vertices), boxes);
    }
    const BoxTree::Node& node(int n) const { return tree->nodes()[static_cast<std::size_t>(n)]; }
    const Aabb& box(int n) const { return boxes[static_cast<std::size_t>(n)]; }
    const Collider* of;
    const BoxTree* tree;
    std::vector<Aabb> boxes;  // by node
  };

  double lower_bound(int a, int b) const {
    const double gap = box_gap(sides_[0].box(a), sides_[1].box(b));
    return gap * gap;
  }

  void visit(int a, int b) {
    poll_();
    const BoxTree::Node &of_a = sides_[0].node(a), &of_b = sides_[1].node(b);
    if (of_a.is_leaf() && of_b.is_leaf()) return test(of_a, of_b);
    const bool splits_a = of_b.is_leaf() || (!of_a.is_leaf() && sides_[0].box(a).extent().squaredNorm() >
                                                                    sides_[1].box(b).extent().squaredNorm());
    std::array<std::pair<int, int>, 2> halves = splits_a ? std::array{std::pair(a + 1, b), std::pair(of_a.second, b)}
                                                         : std::array{std::pair(a, b + 1), std::pair(a, of_b.second)};
    double first = lower_bound(halves[0].first, halves[0].second),
           second = lower_bound(halves[1].first, halves[1].second);
    if (second < first) std::swap(first, second), std::swap(halves[0], halves[1]);
    if (first < least_) visit(halves[0].first, halves[0].second);
    if (second < least_) visit(halves[1].first, halves[1].second);
  }

  void test(const BoxTree::Node& of_a, const BoxTree::Node& of_b) {
    for (int i = of_a.first; i < of_a.first + of_a.count; ++i)
      for (int j = of_b.first; j < of_b.first + of_b.count; ++j) {
        const int s = sides_[0].tree->order()[static_cast<std::size_t>(i)],
                  t = sides_[1].tree->order()[static_cast<std::size_t>(j)];
        const double now =
            closest_features(corners_of(*sides_[0].of, s), corners_of(*sides_[1].of, t)).squared_distance;
        if (now >= least_) continue;
        least_ = now;
        best_ = TrianglePair{{}, {}, TriangleIndex(s), TriangleIndex(t), false};
      }
  }

  std::array<Side, 2> sides_;
  double least_ = INFINITY;  // squared
  std::optional<TrianglePair> best_;
  InterruptPoll poll_;
};

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
  std::tie(best.kind_a, best.index_a) = feature_at(a, best.triangle_a, best.point_a);
  std::tie(best.kind_b, best.index_b) = feature_at(b, best.triangle_b, best.point_b);
  // nearer than what places are known to, the line between the points is rounding, and what touches there tells
  const double known = kRounding * (a.bounds.extent().norm() + b.bounds.extent().norm());
  Vec3 normal = Vec3::Zero();
  if (best.distance <= known)
    normal = separating_direction(SurfaceView(a, 0), {best.kind_a, best.index_a}, SurfaceView(b, 1),
                                  {best.kind_b, best.index_b})
                 .first;
  if (normal.isZero(0.0) && best.distance > 0.0) normal = (best.point_a - best.point_b) / best.distance;
  if (!normal.isZero(0.0)) best.normal = normal;
  return best;
}

/// From one point of a contact to the other, metres; less than 0 where they overlap.
double way(const Collision& c) { return c.gap <= 0.0 ? c.gap : (c.point_a - c.point_b).norm(); }

/// Contacts speak of overlap only about what is near: far away a corner may be behind a face and beside it.
const Collision* nearest_contact(const std::vector<Collision>& contacts, bool looks_for_overlap) {
  const Collision* best = nullptr;
  for (const Collision& c : contacts)
    if ((looks_for_overlap || c.gap > 0.0) && (best == nullptr || way(c) < way(*best))) best = &c;
  return best;
}

/// A body as triangles, which a polyhedron is as well as a mesh.
struct Triangulated {
  MeshPointer made;
  std::vector<Vec3> vertices;
  Collider collider;
};

std::unique_ptr<Triangulated> triangulated(const Collider& c) {
  auto body = std::make_unique<Triangulated>();
  body->collider = c;
  if (is_mesh(c)) return body;
  body->made = make_surface(c.shape->drawn());
  for (const Vec3& x : body->made->mesh.vertices) body->vertices.push_back(c.pose.apply(x));
  body->collider.surface = body->made.get();
  body->collider.vertices = body->vertices;
  return body;
}

/// What one unit of distance is for a body, metres.
double size_of(const Collider& c) {
  const double size = c.bounds.extent().norm();
  return std::isfinite(size) ? size : INFINITY;
}

}  // namespace

double box_gap(const Aabb& a, const Aabb& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm(); }

NearestFeatures features_of(const Collision& contact) {
  const FeaturePair f = features_of_key(contact.feature);
  return {contact.gap,        contact.point_a, contact.point_b, contact.normal, contact.triangle_a,
          contact.triangle_b, f.kind_a,        f.kind_b,        f.index_a,      f.index_b};
}

NearestSearch::NearestSearch() : triangles_(make_named(narrow_phases(), "bvh")) {}

std::optional<NearestFeatures> NearestSearch::within(std::span<const Collider> colliders, BodyPair pair,
                                                     bool looks_for_overlap) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  const ContactQuery query{true, pair.margin, 0.0};
  std::vector<Collision> contacts;
  if (!is_mesh(a) || !is_mesh(b)) {
    primitive_contacts(colliders, pair, query, contacts);
    const Collision* nearest = nearest_contact(contacts, looks_for_overlap);
    if (nearest == nullptr) return std::nullopt;
    NearestFeatures found = features_of(*nearest);
    found.distance = way(*nearest);
    return found;
  }
  std::vector<TrianglePair> found;
  triangles_->find(colliders, std::span(&pair, 1), found);
  if (found.empty()) return std::nullopt;
  if (std::none_of(found.begin(), found.end(), [](const TrianglePair& t) { return t.intersecting; }))
    return nearest_of(a, b, found);
  proximity_contacts(colliders, pair, found, pair.margin, 0.0, contacts);
  const Collision* nearest = nearest_contact(contacts, true);
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
  // what is near or overlaps is the business of contacts; beyond that no two surfaces cross
  const double near = std::min(limit, kFirstLook * size);
  if (gap <= near)
    if (auto nearest = within(colliders, {a, b, near}, true); nearest && nearest->distance <= near) return nearest;
  const bool mesh_a = is_mesh(colliders[a]), mesh_b = is_mesh(colliders[b]);
  if ((mesh_a || mesh_b) && is_faceted(*colliders[a].shape) && is_faceted(*colliders[b].shape)) {
    const auto of_a = triangulated(colliders[a]), of_b = triangulated(colliders[b]);
    const auto pair = TreeSearch(of_a->collider, of_b->collider).nearest(limit);
    if (!pair) return std::nullopt;
    NearestFeatures nearest = nearest_of(of_a->collider, of_b->collider, std::span(&*pair, 1));
    if (!mesh_a) nearest.kind_a = Feature::shape, nearest.index_a = 0, nearest.triangle_a = {};
    if (!mesh_b) nearest.kind_b = Feature::shape, nearest.index_b = 0, nearest.triangle_b = {};
    return nearest;
  }
  // farther and farther: what is far away may be many triangles
  double reach = gap + kFirstLook * size;
  for (int i = 0; i < kDoublings; ++i, reach *= 2.0) {
    check_interrupt();
    const double now = std::min(reach, limit);
    if (auto nearest = within(colliders, {a, b, now}, false); nearest && nearest->distance <= now) return nearest;
    if (now >= limit || !std::isfinite(now)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace impinge
