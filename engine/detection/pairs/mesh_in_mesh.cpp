#include "engine/detection/pairs/mesh_in_mesh.hpp"

#include <algorithm>
#include <optional>

#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/deepest_vertex.hpp"
#include "engine/detection/pairs/ball_against_mesh.hpp"

namespace impinge {
namespace {

constexpr double kSmall = 0.8;  // of the other's size
constexpr double kDeep = 0.25;  // of the small one's size

/// The vertex that lies farthest against a direction, of those that triangles have.
int farthest_against(const SurfaceView& view, const Collider& mesh, const Vec3& direction) {
  int farthest = mesh.mesh().mesh.triangles.front()[0];
  for (const Triangle& t : mesh.mesh().mesh.triangles)
    for (int v : t)
      if (view.vertex(v).dot(direction) < view.vertex(farthest).dot(direction)) farthest = v;
  return farthest;
}

/// The sink's two meshes, the first of which may be inside the second.
class Inside {
 public:
  explicit Inside(ContactSink& sink) : sink_(sink), inner_(sink.first(), 0), outer_(sink.second(), 1) {}

  Vec3 any_point() const { return inner_.vertex(inner_.triangle(0)[0]); }
  /// A rigid body's centre of mass: pushed there, a body doesn't turn on its way.
  Vec3 middle() const { return inner_.is_deforming() ? sink_.first().bounds.center() : sink_.first().pose.position; }

  /// Whether most of the inner mesh's vertices are, by some of them.
  bool is_most() const {
    constexpr std::size_t kAsked = 64;
    const std::span<const Vec3> all = sink_.first().vertices;
    const std::size_t stride = (all.size() + kAsked - 1) / kAsked;
    std::size_t asked = 0, found = 0;
    for (std::size_t v = 0; v < all.size(); v += stride) ++asked, found += way_out(all[v]) ? 1 : 0;
    return 2 * found > asked;
  }

  std::optional<Collision> way_out(const Vec3& x) const { return impinge::way_out(sink_, outer_, x); }

  /// For the whole body, along a way that one of its points has.
  void add(const Collision& way) {
    Candidate c;
    c.normal = way.normal;
    c.kind_first = Feature::vertex;
    c.index_first = farthest_against(inner_, sink_.first(), way.normal);
    c.point_first = inner_.vertex(c.index_first);
    // a point of a rigid body needn't be on its surface
    if (!inner_.is_deforming()) c.point_first = middle() + (c.point_first - middle()).dot(c.normal) * c.normal;
    c.triangle_first = inner_.triangle_of({Feature::vertex, c.index_first});
    c.point_second = way.point_b;
    c.triangle_second = way.triangle_b;
    c.kind_second = Feature::face;
    c.index_second = way.triangle_b;
    sink_.add(c);
  }

 private:
  ContactSink& sink_;
  SurfaceView inner_, outer_;
};

/// Nothing crosses: where one point of the first mesh is, all are. Whatever turns on its way keeps to one by its middle.
bool add_enclosed_mesh(ContactSink& sink) {
  Inside inside(sink);
  std::optional<Collision> way = inside.way_out(inside.any_point());
  if (!way) return false;
  if (const std::optional<Collision> of_middle = inside.way_out(inside.middle())) way = of_middle;
  inside.add(*way);
  return true;
}

/// A small mesh that has come through a large one's surface in part, and is still deep in it: where what sticks out is
/// seen alone, the shortest way is back in. How deep says a vertex: the middle of a nut is inside its bolt.
bool add_deep(std::span<const Collider> colliders, const BodyPair& pair, std::span<const TrianglePair> triangles,
              const ContactQuery& query, std::vector<Collision>& contacts) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  const bool is_a_small = a.size < b.size;
  const double small = std::min(a.size, b.size);
  if (!(small <= kSmall * std::max(a.size, b.size)) || !(is_a_small ? b : a).mesh().topology.is_closed()) return false;
  const std::optional<Collision> deepest = find_overlap(colliders, pair, triangles).deepest;
  if (!deepest || deepest->gap > -kDeep * small) return false;
  const FeaturePair features = features_of_key(deepest->feature);
  const bool is_of_small = (is_a_small ? features.kind_a : features.kind_b) == Feature::vertex;
  ContactSink sink(colliders, pair, !is_a_small, query, contacts), turned(colliders, pair, is_a_small, query, contacts);
  Inside inside(sink);
  // the middle of a ring is no part of it, and tells where it is only if the ring is there too
  const bool tells = way_out(turned, SurfaceView(turned.second(), 1), inside.middle()).has_value() || inside.is_most();
  const std::optional<Collision> way = tells ? inside.way_out(inside.middle()) : std::nullopt;
  if (way)
    inside.add(*way);
  else if (is_of_small)
    contacts.push_back(*deepest);
  return way || is_of_small;
}

}  // namespace

bool may_be_inside(const Collider& mesh, const Collider& body) {
  const Aabb &outer = mesh.bounds, &inner = body.bounds;
  return (outer.min.array() <= inner.min.array()).all() && (inner.max.array() <= outer.max.array()).all() &&
         mesh.mesh().topology.is_closed();
}

bool mesh_in_mesh(std::span<const Collider> colliders, const BodyPair& pair, std::span<const TrianglePair> triangles,
                  const ContactQuery& query, std::vector<Collision>& contacts) {
  if (pair.a == pair.b) return false;
  if (any_crosses(triangles)) return add_deep(colliders, pair, triangles, query, contacts);
  for (const bool is_swapped : {false, true}) {
    const Collider &inner = colliders[is_swapped ? pair.b : pair.a], &outer = colliders[is_swapped ? pair.a : pair.b];
    if (!may_be_inside(outer, inner) || inner.mesh().mesh.triangles.empty()) continue;
    ContactSink sink(colliders, pair, is_swapped, query, contacts);
    if (add_enclosed_mesh(sink)) return true;
  }
  return false;
}

}  // namespace impinge
