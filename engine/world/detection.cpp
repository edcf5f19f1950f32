#include "engine/world/detection.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/pairs/primitive.hpp"

namespace impinge {
namespace {

bool is_moving(const RigidBody& body) {
  if (body.has_freedom()) return !body.asleep;
  return body.kind == BodyKind::scripted && !(body.velocity.isZero(0.0) && body.scripted_angular_velocity.isZero(0.0));
}

/// Whether the pair can give a contact that anything responds to.
bool is_wanted(const RigidBody& a, const RigidBody& b) {
  return (a.has_freedom() || b.has_freedom()) && (is_moving(a) || is_moving(b));
}

/// The box a body fills during the sub-step, plus half the activation distance.
Aabb swept_bounds(const Collider& collider, double radius, double activation, double time_step) {
  Aabb box = collider.bounds;
  for (std::size_t i = 0; i < collider.vertex_velocities.size(); ++i)
    box.include(Vec3(collider.vertices[i] + time_step * collider.vertex_velocities[i]));
  const Vec3 shift = time_step * collider.velocity;
  box.min += shift.cwiseMin(0.0);
  box.max += shift.cwiseMax(0.0);
  return box.inflated(0.5 * activation + time_step * collider.angular_velocity.norm() * radius);
}

}  // namespace

void Detection::run(std::span<const RigidBody> bodies, const Parameters& parameters, double time_step,
                    StageTimes& times) {
  {
    const StageTimer timer(times.broad_ms);
    find_pairs(bodies, parameters, time_step);
  }
  check_interrupt();
  const StageTimer timer(times.narrow_ms);
  find_collisions(parameters, time_step);
}

void Detection::find_pairs(std::span<const RigidBody> bodies, const Parameters& parameters, double time_step) {
  const bool proximity = parameters.contact.points == ContactPoints::proximity;
  const double activation = proximity ? parameters.contact.activation_distance : 0.0;
  colliders_.resize(bodies.size());
  boxes_.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& body = bodies[i];
    Collider& c = colliders_[i];
    c.shape = body.shape.get();
    c.pose = body.pose;
    c.vertices = body.world_vertices;
    c.bounds = body.bounds();
    c.velocity = body.soft ? Vec3::Zero() : body.velocity;
    c.angular_velocity = body.soft ? Vec3::Zero() : body.angular_velocity();
    c.vertex_velocities = body.soft ? std::span<const Vec3>(body.soft->surface_velocity) : std::span<const Vec3>();
    c.self_collision = body.self_collision;
    c.mean_edge = body.mean_edge;
    boxes_[i] = proximity ? swept_bounds(c, body.radius, activation, time_step) : c.bounds;
  }
  parameters.broad_phase.method->find(boxes_, box_pairs_);
  const auto speed = [&](std::size_t i) {
    double fastest = colliders_[i].velocity.norm() + colliders_[i].angular_velocity.norm() * bodies[i].radius;
    for (const Vec3& v : colliders_[i].vertex_velocities) fastest = std::max(fastest, v.norm());
    return fastest;
  };

  pairs.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].soft && bodies[i].self_collision && !bodies[i].asleep)
      pairs.push_back({static_cast<int>(i), static_cast<int>(i), activation});
  for (const auto& [a, b] : box_pairs_) {
    if (!is_wanted(bodies[a], bodies[b])) continue;
    // how far the surfaces can approach in the sub-step widens the search; for meshes by one edge length at most, since
    // the triangles in reach grow with its square: what is faster overlaps a little and is pushed out
    const double approach = bodies[a].soft || bodies[b].soft
                                ? time_step * (speed(a) + speed(b))
                                : time_step * ((colliders_[a].velocity - colliders_[b].velocity).norm() +
                                               colliders_[a].angular_velocity.norm() * bodies[a].radius +
                                               colliders_[b].angular_velocity.norm() * bodies[b].radius);
    const double margin =
        proximity ? activation + std::min(approach, std::max(bodies[a].mean_edge, bodies[b].mean_edge)) : 0.0;
    pairs.push_back({a, b, margin});
  }
  std::sort(pairs.begin(), pairs.end());
}

void Detection::find_collisions(const Parameters& parameters, double time_step) {
  const bool proximity = parameters.contact.points == ContactPoints::proximity;
  const ContactQuery query{proximity, parameters.contact.activation_distance, time_step};
  const auto is_mesh_pair = [&](const BodyPair& pair) {
    return colliders_[pair.a].shape->mesh() != nullptr && colliders_[pair.b].shape->mesh() != nullptr;
  };
  std::vector<BodyPair> mesh_pairs;
  for (const BodyPair& pair : pairs)
    if (is_mesh_pair(pair)) mesh_pairs.push_back(pair);
  triangle_pairs.clear();
  if (!mesh_pairs.empty()) parameters.narrow_phase.method->find(colliders_, mesh_pairs, triangle_pairs);
  check_interrupt();

  found_.resize(std::max(found_.size(), pairs.size()));
  parallel_for(pairs.size(), 1, [&](std::size_t i) {
    const BodyPair& pair = pairs[i];
    std::vector<Collision>& out = found_[i];
    out.clear();
    if (!is_mesh_pair(pair)) {
      primitive_contacts(colliders_, pair, query, out);
      return;
    }
    const auto before = [](const TrianglePair& t, const BodyPair& p) { return t.a != p.a ? t.a < p.a : t.b < p.b; };
    const auto first = std::lower_bound(triangle_pairs.begin(), triangle_pairs.end(), pair, before);
    auto last = first;
    while (last != triangle_pairs.end() && last->a == pair.a && last->b == pair.b) ++last;
    const std::span<const TrianglePair> triangles(first, last);
    if (triangles.empty()) return;
    if (proximity)
      proximity_contacts(colliders_, pair, triangles, query.activation, time_step, out);
    else
      intersection_contacts(colliders_, pair, triangles, out);
  });
  collisions.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    collisions.insert(collisions.end(), found_[i].begin(), found_[i].end());
}

}  // namespace impinge
