#include "engine/detection/pairs/contact_sink.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

/// A bound on how fast any two points of the colliders that are near each other approach, m/s.
double approach_speed(const Collider& a, const Collider& b, bool either_may_stop) {
  const Collider& bounded = b.shape->as<Plane>() != nullptr ? a : b;
  const Vec3 center = bounded.bounds.center();
  // the points of a contact lie within the bounded collider or a gap away from it; twice its radius covers what matters
  const double radius = bounded.bounds.extent().norm();
  double speed = (a.velocity_at(center) - b.velocity_at(center)).norm() +
                 (a.angular_velocity - b.angular_velocity).norm() * radius;
  for (const Collider* c : {&a, &b}) {
    double extra_sq = 0.0;
    for (std::size_t i = 0; i < c->vertex_velocities.size(); ++i)
      extra_sq = std::max(extra_sq, (c->vertex_velocities[i] - c->velocity_at(c->vertices[i])).squaredNorm());
    speed += std::sqrt(extra_sq);
  }
  if (either_may_stop)
    for (const Collider* c : {&a, &b})
      speed = std::max(speed, c->velocity_at(center).norm() + c->angular_velocity.norm() * radius);
  return speed;
}

}  // namespace

Vec3 material_velocity(const Collider& collider, const Vec3& point, int triangle) {
  if (collider.vertex_velocities.empty() || triangle < 0) return collider.velocity_at(point);
  const Triangle& t = collider.mesh().mesh.triangles[triangle];
  const Vec3 &a = collider.vertices[t[0]], &b = collider.vertices[t[1]], &c = collider.vertices[t[2]];
  const Vec3 normal = (b - a).cross(c - a);
  const double area_sq = normal.squaredNorm();
  if (!(area_sq > 0.0)) return collider.vertex_velocities[t[0]];
  const double v = (point - a).cross(c - a).dot(normal) / area_sq;
  const double w = (b - a).cross(point - a).dot(normal) / area_sq;
  return (1.0 - v - w) * collider.vertex_velocities[t[0]] + v * collider.vertex_velocities[t[1]] +
         w * collider.vertex_velocities[t[2]];
}

ContactSink::ContactSink(std::span<const Collider> colliders, const BodyPair& pair, bool swapped,
                         const ContactQuery& query, std::vector<Collision>& contacts)
    : first_(&colliders[swapped ? pair.b : pair.a]),
      second_(&colliders[swapped ? pair.a : pair.b]),
      pair_(pair),
      swapped_(swapped),
      query_(query),
      contacts_(contacts),
      begin_(contacts.size()) {
  if (query_.proximity) {
    reach_ = std::max(0.0, query_.activation);
    if (query_.time_step > 0.0)
      reach_ = std::max(reach_, query_.time_step * approach_speed(*first_, *second_, query_.either_may_stop));
  }
}

bool ContactSink::add(const Candidate& c) {
  const double gap = c.normal.dot(c.point_first - c.point_second);
  if (gap > 0.0) {
    if (!query_.proximity) return false;
    if (gap > query_.activation) {
      if (query_.either_may_stop) {
        if (gap > reach_) return false;
      } else {
        const Vec3 relative = material_velocity(*first_, c.point_first, c.triangle_first) -
                              material_velocity(*second_, c.point_second, c.triangle_second);
        if (!(gap + query_.time_step * c.normal.dot(relative) < 0.0)) return false;
      }
    }
  }
  IMPINGE_ASSERT(std::isfinite(gap));
  Collision contact;
  contact.body_a = pair_.a;
  contact.body_b = pair_.b;
  contact.gap = gap;
  const BodyIndex first_body = swapped_ ? pair_.b : pair_.a, second_body = swapped_ ? pair_.a : pair_.b;
  if (c.owner != NormalOwner::neither) contact.normal_owner = c.owner == NormalOwner::first ? first_body : second_body;
  if (swapped_) {
    contact.point_a = c.point_second;
    contact.point_b = c.point_first;
    contact.normal = -c.normal;
    contact.triangle_a = TriangleIndex(c.triangle_second);
    contact.triangle_b = TriangleIndex(c.triangle_first);
  } else {
    contact.point_a = c.point_first;
    contact.point_b = c.point_second;
    contact.normal = c.normal;
    contact.triangle_a = TriangleIndex(c.triangle_first);
    contact.triangle_b = TriangleIndex(c.triangle_second);
  }
  contact.feature = key_of(c);
  contacts_.push_back(contact);
  return true;
}

std::uint64_t ContactSink::key_of(const Candidate& c) const {
  return swapped_ ? feature_key(c.kind_second, c.index_second, c.kind_first, c.index_first)
                  : feature_key(c.kind_first, c.index_first, c.kind_second, c.index_second);
}

bool ContactSink::add_new(const Candidate& c) {
  const std::uint64_t key = key_of(c);
  for (std::size_t i = begin_; i < contacts_.size(); ++i)
    if (contacts_[i].feature == key) return false;
  return add(c);
}

bool ContactSink::covers(const Candidate& c, double distance, double tie) const {
  const double gap = c.normal.dot(c.point_first - c.point_second);
  for (std::size_t i = begin_; i < contacts_.size(); ++i) {
    const Vec3& place = swapped_ ? contacts_[i].point_b : contacts_[i].point_a;
    if ((place - c.point_first).norm() <= distance && contacts_[i].gap <= gap + tie) return true;
  }
  return false;
}

void ContactSink::forget_beside(const Candidate& c, double distance) {
  const std::uint64_t key = key_of(c);
  const auto is_beside = [&](const Collision& known) {
    const Vec3 &on_first = swapped_ ? known.point_b : known.point_a,
               &on_second = swapped_ ? known.point_a : known.point_b;
    return known.feature != key &&
           ((on_first - c.point_first).norm() <= distance || (on_second - c.point_second).norm() <= distance);
  };
  const auto first = contacts_.begin() + static_cast<std::ptrdiff_t>(begin_);
  contacts_.erase(std::remove_if(first, contacts_.end(), is_beside), contacts_.end());
}

}  // namespace impinge
