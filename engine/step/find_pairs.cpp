#include "engine/step/find_pairs.hpp"

#include <algorithm>

#include "engine/contact/pair_scale.hpp"
#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

/// What moves is held against every box in less time than the broad phase takes if it is no more than this, and than a
/// share of all.
constexpr std::size_t kFew = 50, kShare = 8;

void show(const Body& body, Collider& c) {
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
  const std::size_t count = static_cast<std::size_t>(bodies.size().value());
  const std::span<const BodyIndex> whose = bodies.to_renew(colliders.size() == count);
  colliders.resize(count);
  for (const BodyIndex b : whose) show(bodies[b], colliders[b]);
}

void SearchBoxes::update(const Bodies& bodies, std::span<const Collider> colliders, const ContactSettings& settings,
                         double time_step) {
  const std::span<const BodyIndex> whose = bodies.to_renew(by_body.size() == colliders.size());
  by_body.resize(colliders.size());
  if (whose.size() == by_body.size()) {
    largest = 0.0;
    for (const Body& body : bodies)
      if (body.has_freedom()) largest = std::max(largest, body.size);
  }
  const bool proximity = settings.points == ContactPoints::proximity;
  for (const BodyIndex b : whose)
    by_body[b] = proximity ? swept_bounds(colliders[b], bodies[b].radius,
                                          settings.activation(std::min(bodies[b].size, largest)), time_step)
                           : colliders[b].bounds;
}

void find_moving_pairs(const Bodies& bodies, std::span<const Aabb> boxes, BroadPhase& broad_phase,
                       std::vector<BoxPair>& pairs) {
  std::vector<BodyIndex> moving;
  for (const BodyIndex b : bodies.active())
    if (bodies[b].is_moving()) moving.push_back(b);
  if (moving.size() > std::min(kFew, boxes.size() / kShare) || broad_phase.tests_every_pair())
    return broad_phase.find(boxes, pairs);
  pairs.clear();
  const auto moves = [&](int i) { return std::binary_search(moving.begin(), moving.end(), BodyIndex(i)); };
  for (const int i : moving) {
    check_interrupt();
    for (int j = 0; j < static_cast<int>(boxes.size()); ++j)
      if (overlap(boxes[i], boxes[j]) && i != j && (i < j || !moves(j)))
        pairs.emplace_back(std::min(i, j), std::max(i, j));
  }
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

void find_pairs(const Bodies& bodies, std::span<const Collider> colliders, std::span<const Aabb> boxes,
                const ContactSettings& settings, double time_step, BroadPhase& broad_phase,
                std::vector<BodyPair>& pairs) {
  std::vector<BoxPair> box_pairs;
  find_moving_pairs(bodies, boxes, broad_phase, box_pairs);

  pairs.clear();
  for (const BodyIndex b : bodies.active())
    if (bodies[b].can_touch_itself() && !bodies[b].asleep) pairs.push_back({b, b, settings.activation(bodies[b].size)});
  for (const auto& [first, second] : box_pairs) {
    const BodyIndex a(first), b(second);
    if (!may_respond(bodies, a, b)) continue;
    pairs.push_back({a, b, search_margin(bodies, colliders, a, b, settings, time_step)});
  }
  std::sort(pairs.begin(), pairs.end());
}

}  // namespace impinge
