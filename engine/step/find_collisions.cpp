#include "engine/step/find_collisions.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/ghost_contacts.hpp"
#include "engine/detection/pairs/flight.hpp"
#include "engine/detection/pairs/mesh_in_mesh.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/surface/exempt_pairs.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

bool is_mesh_pair(std::span<const Collider> colliders, const BodyPair& pair) {
  return colliders[pair.a].shape->mesh() != nullptr && colliders[pair.b].shape->mesh() != nullptr;
}

/// Those of one pair.
std::span<const TrianglePair> part_of(std::span<const TrianglePair> all, const BodyPair& pair) {
  const auto before = [](const TrianglePair& t, const BodyPair& p) { return t.a != p.a ? t.a < p.a : t.b < p.b; };
  const auto first = std::lower_bound(all.begin(), all.end(), pair, before);
  auto last = first;
  while (last != all.end() && last->a == pair.a && last->b == pair.b) ++last;
  return {first, last};
}

ContactQuery query_for(std::span<const Collider> colliders, const BodyPair& pair, const ContactSettings& settings,
                       double time_step, bool either_may_stop, const Vec3& gravity) {
  const double size = std::min(colliders[pair.a].size, colliders[pair.b].size);
  return {settings.points == ContactPoints::proximity,
          settings.activation_distance.at(size),
          time_step,
          either_may_stop,
          time_step * time_step * gravity,
          Vec3::Zero()};
}

/// Of two meshes, by their triangles that are near.
void near_contacts(std::span<const Collider> colliders, const BodyPair& pair, std::span<const TrianglePair> triangles,
                   const ContactQuery& query, std::vector<Collision>& contacts) {
  if (mesh_in_mesh(colliders, pair, triangles, query, contacts) || triangles.empty()) return;
  const std::size_t begin = contacts.size();
  proximity_contacts(colliders, pair, triangles, query.activation, query.time_step, contacts);
  turn_ghost_contacts(colliders, pair,
                      {query.time_step, query.activation, query.fall, query.sunk, query.either_may_stop}, begin,
                      contacts);
}

/// The same from nothing.
void mesh_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                   std::vector<Collision>& contacts) {
  std::vector<TrianglePair> triangles;
  make_named(narrow_phases(), "bvh")->find(colliders, std::span(&pair, 1), triangles);
  near_contacts(colliders, pair, triangles, query, contacts);
}

/// The colliders, those of deforming meshes that several shapes are near with their trees' boxes where they are now: one
/// fit takes as long as one shape's look at every triangle.
class FittedColliders {
 public:
  FittedColliders(std::span<const Collider> colliders, std::span<const BodyPair> pairs) : all_(colliders) {
    std::vector<int> shapes(colliders.size(), 0);  // near each deforming mesh
    for (const BodyPair& pair : pairs)
      for (const auto& [mesh, other] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
        if (!colliders[mesh].vertex_velocities.empty() && asks_for_triangles(*colliders[other].shape)) ++shapes[mesh];
    if (std::none_of(shapes.begin(), shapes.end(), is_worth_it)) return;
    own_.assign(colliders.begin(), colliders.end());
    boxes_.resize(colliders.size());
    parallel_for(own_.size(), 1, [&](std::size_t i) {
      if (!is_worth_it(shapes[i])) return;
      const SurfaceMesh& mesh = own_[i].mesh();
      mesh.tree().fit(triangle_boxes(mesh.mesh.triangles, own_[i].vertices), boxes_[i]);
      own_[i].node_boxes = boxes_[i];
    });
    all_ = own_;
  }
  std::span<const Collider> all() const { return all_; }

 private:
  /// A plane is held against every vertex.
  static bool asks_for_triangles(const Shape& shape) { return shape.mesh() == nullptr && shape.as<Plane>() == nullptr; }
  static bool is_worth_it(int shapes) { return shapes > 1; }
  std::span<const Collider> all_;
  std::vector<Collider> own_;
  std::vector<std::vector<Aabb>> boxes_;  // by body
};

}  // namespace

void find_collisions(std::span<const Collider> colliders, std::span<const BodyPair> pairs, const Detecting& by,
                     double time_step, std::vector<TrianglePair>& triangle_pairs, std::vector<Collision>& collisions,
                     std::vector<Approach>* approaches) {
  const bool proximity = by.contact.points == ContactPoints::proximity;
  std::vector<BodyPair> mesh_pairs;
  for (const BodyPair& pair : pairs)
    if (is_mesh_pair(colliders, pair)) mesh_pairs.push_back(pair);
  triangle_pairs.clear();
  if (!mesh_pairs.empty()) by.narrow_phase.find(colliders, mesh_pairs, triangle_pairs);
  std::erase_if(triangle_pairs, [&](const TrianglePair& t) {
    const ExemptPairs* exempt = t.a == t.b ? colliders[t.a].exempt_pairs : nullptr;
    return exempt != nullptr && exempt->has(t.triangle_a, t.triangle_b);
  });
  check_interrupt();

  const FittedColliders fitted(colliders, pairs);
  std::vector<std::vector<Collision>> found(pairs.size());  // one slot a pair, so that threads don't share
  std::vector<double> meeting(pairs.size(), 0.0);
  parallel_for(pairs.size(), 1, [&](std::size_t i) {
    const BodyPair& pair = pairs[i];
    const ContactQuery query = query_for(colliders, pair, by.contact, time_step, by.either_may_stop, by.gravity);
    if (!is_mesh_pair(colliders, pair)) {
      primitive_contacts(fitted.all(), pair, query, found[i]);
    } else {
      const std::span<const TrianglePair> triangles = part_of(triangle_pairs, pair);
      if (proximity)
        near_contacts(colliders, pair, triangles, query, found[i]);
      else if (!triangles.empty())
        intersection_contacts(colliders, pair, triangles, found[i]);
    }
    if (found[i].empty() && approaches == nullptr) return;
    if (!by.looks_ahead || !fly_together(colliders[pair.a], colliders[pair.b], query, found[i])) return;
    const std::optional<double> time = time_of_meeting(colliders[pair.a], colliders[pair.b], query);
    if (!time)
      found[i].clear();  // it is a plane that they would meet, not each other
    else
      meeting[i] = *time;
  });
  collisions.clear();
  for (const std::vector<Collision>& list : found) collisions.insert(collisions.end(), list.begin(), list.end());
  if (approaches == nullptr) return;
  approaches->clear();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (meeting[i] > 0.0) approaches->push_back({pairs[i], meeting[i]});
}

std::vector<Collision> collisions_of(const Approach& approach, std::span<const Collider> colliders, const Detecting& by,
                                     double time_step) {
  return contacts_where_they_meet(
      colliders, approach.pair, query_for(colliders, approach.pair, by.contact, time_step, false, by.gravity),
      approach.time, is_mesh_pair(colliders, approach.pair) ? mesh_contacts : primitive_contacts);
}

}  // namespace impinge
