#include "engine/step/find_pairs.hpp"

#include <algorithm>

#include "engine/contact/pair_scale.hpp"

namespace impinge {
namespace {

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

double fastest_point(const Collider& c, double radius) {
  double fastest = c.velocity.norm() + c.angular_velocity.norm() * radius;
  for (const Vec3& v : c.vertex_velocities) fastest = std::max(fastest, v.norm());
  return fastest;
}

/// The box that both sweep.
Aabb common(const Aabb& a, const Aabb& b) { return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)}; }

}  // namespace

void make_colliders(const Bodies& bodies, std::vector<Collider>& colliders) {
  colliders.resize(static_cast<std::size_t>(bodies.size().value()));
  for (BodyIndex i(0); i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    Collider& c = colliders[i];
    c.shape = body.shape.get();
    c.pose = body.pose;
    c.vertices = body.world_vertices;
    c.bounds = body.bounds();
    c.vertex_velocities = body.vertex_velocities();
    const Twist twist = c.vertex_velocities.empty() ? body.twist() : Twist();
    c.velocity = twist.linear;
    c.angular_velocity = twist.angular;
    c.self_collision = body.self_collision;
    c.exempt_pairs = body.exempt_pairs.get();
    c.mean_edge = body.mean_edge;
    c.size = body.size;
  }
}

std::vector<Aabb> search_boxes(const Bodies& bodies, std::span<const Collider> colliders,
                               const ContactSettings& settings, double time_step) {
  const bool proximity = settings.points == ContactPoints::proximity;
  double largest = 0.0;  // of bodies that move freely: a pair is no larger
  for (const Body& body : bodies)
    if (body.has_freedom()) largest = std::max(largest, body.size);
  std::vector<Aabb> boxes;
  boxes.reserve(colliders.size());
  for (BodyIndex i(0); i < bodies.size(); ++i)
    boxes.push_back(proximity ? swept_bounds(colliders[i], bodies[i].radius,
                                             settings.activation(std::min(bodies[i].size, largest)), time_step)
                              : colliders[i].bounds);
  return boxes;
}

double approach(const Collider& a, double radius_a, const Collider& b, double radius_b, double time_step) {
  if (!a.vertex_velocities.empty() || !b.vertex_velocities.empty())
    return time_step * (fastest_point(a, radius_a) + fastest_point(b, radius_b));
  const double turn = time_step * (a.angular_velocity.norm() + b.angular_velocity.norm());
  const double anywhere = time_step * ((a.velocity - b.velocity).norm() + a.angular_velocity.norm() * radius_a +
                                       b.angular_velocity.norm() * radius_b);
  // the speed between two bodies is a linear function of the place: largest at a corner of where they can meet
  const Aabb where = common(swept_bounds(a, radius_a, 0.0, time_step), swept_bounds(b, radius_b, 0.0, time_step));
  if (where.is_empty() || !where.min.allFinite() || !where.max.allFinite()) return anywhere;
  double fastest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x((corner & 1) != 0 ? where.max.x() : where.min.x(), (corner & 2) != 0 ? where.max.y() : where.min.y(),
                 (corner & 4) != 0 ? where.max.z() : where.min.z());
    fastest = std::max(fastest, (a.velocity_at(x) - b.velocity_at(x)).norm());
  }
  // the two points that meet are not at one place yet
  return std::min(anywhere, time_step * fastest * (1.0 + turn));
}

double search_margin(const Bodies& bodies, std::span<const Collider> colliders, BodyIndex a, BodyIndex b,
                     const ContactSettings& settings, double time_step) {
  if (settings.points != ContactPoints::proximity) return 0.0;
  // the approach widens the search; for meshes by one edge length at most, since the triangles in reach grow with its
  // square: what is faster overlaps a little and is pushed out
  const double reach = approach(colliders[a], bodies[a].radius, colliders[b], bodies[b].radius, time_step);
  return settings.activation(pair_size(bodies[a], bodies[b])) +
         std::min(reach, std::max(bodies[a].mean_edge, bodies[b].mean_edge));
}

void find_pairs(const Bodies& bodies, std::span<const Collider> colliders, const ContactSettings& settings,
                double time_step, BroadPhase& broad_phase, std::vector<BodyPair>& pairs) {
  std::vector<BoxPair> box_pairs;
  broad_phase.find(search_boxes(bodies, colliders, settings, time_step), box_pairs);

  pairs.clear();
  for (BodyIndex i(0); i < bodies.size(); ++i)
    if (bodies[i].can_touch_itself() && !bodies[i].asleep) pairs.push_back({i, i, settings.activation(bodies[i].size)});
  for (const auto& [first, second] : box_pairs) {
    const BodyIndex a(first), b(second);
    if (!may_respond(bodies, a, b)) continue;
    pairs.push_back({a, b, search_margin(bodies, colliders, a, b, settings, time_step)});
  }
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace impinge
