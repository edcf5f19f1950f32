#include "engine/world/group_assembly.hpp"

#include <algorithm>
#include <cmath>

#include "engine/world/step_record.hpp"

namespace impinge {
namespace {

double pair_restitution(const RigidBody& a, const RigidBody& b, const Parameters& parameters) {
  const auto of = [&](const RigidBody& body) { return body.restitution < 0.0 ? parameters.contact.restitution : body.restitution; };
  return std::max(of(a), of(b));
}

/// Overlap below this is rounding, not overlap: pushing it out would cost a solve a sub-step for nothing.
double push_out_slop(const Parameters& parameters) { return 1e-6 * parameters.contact.activation_distance; }

double row_bound(double gap, double free_velocity, double velocity_before, double restitution, const Parameters& parameters, double h) {
  const bool split = parameters.contact.push_out == "split";
  const double bound = gap >= 0.0 ? -gap / h : (split ? 0.0 : std::min(-gap / h, parameters.contact.max_push_out));
  const bool closes = gap + h * free_velocity < 0.0;
  if (!closes || restitution == 0.0 || velocity_before > -parameters.contact.restitution_threshold) return bound;
  return std::max(bound, -restitution * velocity_before);
}

}  // namespace

double pair_friction(const RigidBody& a, const RigidBody& b, const Parameters& parameters) {
  const auto of = [&](const RigidBody& body) { return body.friction < 0.0 ? parameters.contact.friction : body.friction; };
  return std::sqrt(of(a) * of(b));
}

GroupSystem make_group_system(std::span<const RigidBody> bodies, std::span<const Twist> before, const CollisionGroup& group,
                              std::span<const Collision> collisions, const Parameters& parameters, double time_step) {
  GroupSystem system;
  std::vector<int> local(bodies.size(), -1);
  for (int b : group.bodies) {
    local[b] = static_cast<int>(system.bodies.size());
    system.bodies.push_back({1.0 / bodies[b].mass, bodies[b].world_inertia_inverse(), bodies[b].velocity, bodies[b].angular_velocity()});
  }
  system.contacts.reserve(group.contacts.size());
  for (int c : group.contacts) {
    const Collision& collision = collisions[c];
    const RigidBody& a = bodies[collision.body_a];
    const RigidBody& b = bodies[collision.body_b];
    const Vec3 common = 0.5 * (collision.point_a + collision.point_b);
    ContactRows rows;
    rows.a = local[collision.body_a];
    rows.b = local[collision.body_b];
    const Vec3 t1 = tangent1(collision.normal);
    rows.directions << collision.normal.transpose(), t1.transpose(), collision.normal.cross(t1).transpose();
    rows.arm_a = common - a.pose.position;
    rows.arm_b = common - b.pose.position;
    const auto velocity_of = [&](const Vec3& v, const Vec3& w, const RigidBody& body) { return Vec3(v + w.cross(common - body.pose.position)); };
    if (rows.a < 0) rows.surface += rows.directions * velocity_of(a.velocity, a.angular_velocity(), a);
    if (rows.b < 0) rows.surface -= rows.directions * velocity_of(b.velocity, b.angular_velocity(), b);
    rows.gap = collision.gap;
    rows.friction = pair_friction(a, b, parameters);
    system.contacts.push_back(rows);

    const double free_velocity = system.contact_velocity(system.contacts.size() - 1, false).x();
    const Twist& ta = before[collision.body_a];
    const Twist& tb = before[collision.body_b];
    const double velocity_before = collision.normal.dot(velocity_of(ta.linear, ta.angular, a) - velocity_of(tb.linear, tb.angular, b));
    system.contacts.back().bound =
        row_bound(collision.gap, free_velocity, velocity_before, pair_restitution(a, b, parameters), parameters, time_step);
  }
  system.lambda.assign(system.contacts.size(), Vec3::Zero());
  system.delta_velocity.assign(system.bodies.size(), Vec3::Zero());
  system.delta_angular_velocity.assign(system.bodies.size(), Vec3::Zero());
  return system;
}

bool needs_push_out(const GroupSystem& system, const Parameters& parameters) {
  return parameters.contact.push_out == "split" && parameters.contact.max_push_out > 0.0 &&
         std::any_of(system.contacts.begin(), system.contacts.end(), [&](const ContactRows& c) { return c.gap < -push_out_slop(parameters); });
}

GroupSystem make_push_out_system(const GroupSystem& solved, const Parameters& parameters, double time_step) {
  GroupSystem push = solved;
  for (BodyBlock& body : push.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  for (std::size_t i = 0; i < push.contacts.size(); ++i) {
    ContactRows& rows = push.contacts[i];
    const double gap_after = rows.gap + time_step * solved.contact_velocity(i, true).x();
    rows.surface.setZero();
    rows.friction = 0.0;
    // an overlap is measured after the velocities have moved the bodies: separation that they bring is not added twice
    rows.bound = gap_after >= 0.0 ? -gap_after / time_step : std::min(-gap_after / time_step, parameters.contact.max_push_out);
    push.lambda[i].setZero();
  }
  return push;
}

}  // namespace impinge
