#include "engine/step/turning.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/contact/row_bound.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {
namespace {

constexpr double kFarthestTurn = 0.5;       // radians; what turns farther leaves its contact's plane
constexpr double kTurningTolerance = 1e-3;  // of the activation distance

struct End {
  Pose pose;
  double turn = 0.0;  // radians
};

End end_of(const RigidBody& body, const Vec3& delta_velocity, const Vec3& delta_spin, double time_step) {
  const Vec3 spin = body.angular_velocity() + delta_spin;
  End end{body.pose, time_step * spin.norm()};
  if (end.turn <= kFarthestTurn)
    end.pose = free_flight(body, body.velocity + delta_velocity, body.world_inertia() * spin, time_step);
  return end;
}

/// Of a body that impulses don't move.
End end_of(const Body& body, double time_step) {
  const Twist twist = body.twist();
  return {moved(body.pose, time_step * twist.linear, time_step * twist.angular), time_step * twist.angular.norm()};
}

}  // namespace

std::vector<double> end_gaps(const Bodies& bodies, const AssembledGroup& group, const ContactList& contacts,
                             double time_step) {
  std::vector<End> rigid;
  for (std::size_t i = 0; i < group.rigid.size(); ++i)
    rigid.push_back(end_of(*bodies[group.rigid[i]].as<RigidBody>(), group.system.delta_velocity[i],
                           group.system.delta_angular_velocity[i], time_step));
  const auto end = [&](int block, BodyIndex b) {
    return block >= 0 ? rigid[static_cast<std::size_t>(block)] : end_of(bodies[b], time_step);
  };
  const auto place = [&](const End& of, const ContactSide& side, BodyIndex b, const MaterialPoint& point) {
    if (side.deformable < 0) return of.pose.apply(point.local);
    return Vec3(bodies[b].position_of(point) + time_step * group.system.displacement_velocity(side));
  };
  std::vector<double> gaps(group.contacts.size(), INFINITY);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const Collision* c = contacts.collision(group.contacts[i]);
    if (c == nullptr || c->meeting) continue;
    const ContactRows& row = group.system.contacts[i];
    const auto is_known = [&](const ContactSide& side, BodyIndex body) {
      return side.deformable >= 0 || bodies[body].kind() != BodyKind::deformable;
    };
    if (row.a.rigid < 0 && row.b.rigid < 0) continue;
    if (!is_known(row.a, c->body_a) || !is_known(row.b, c->body_b)) continue;
    const End a = end(row.a.rigid, c->body_a), b = end(row.b.rigid, c->body_b);
    if (!(a.turn <= kFarthestTurn && b.turn <= kFarthestTurn)) continue;
    Vec3 normal = c->normal;
    for (const auto& [owner, to] : {std::pair(c->body_a, &a), std::pair(c->body_b, &b)})
      if (c->normal_owner == owner) normal = to->pose.rotation * (bodies[owner].pose.rotation.transpose() * c->normal);
    const auto& [point_a, point_b] = group.points[i];
    gaps[i] = normal.dot(place(a, row.a, c->body_a, point_a) - place(b, row.b, c->body_b, point_b));
  }
  return gaps;
}

double most_lost(const GroupSystem& system, std::span<const double> end_gaps, const ContactSettings& settings) {
  double most = 0.0;
  for (std::size_t i = 0; i < end_gaps.size(); ++i) {
    const ContactRows& row = system.contacts[i];
    const double lost = std::min(row.gap, 0.0) - end_gaps[i];
    if (lost > kTurningTolerance * settings.activation_distance.at(row.scale.length)) most = std::max(most, lost);
  }
  return most;
}

std::pair<double, double> energy_won(const Bodies& bodies, const AssembledGroup& group) {
  const GroupSystem& s = group.system;
  double with = 0.0, free = 0.0;
  for (std::size_t i = 0; i < group.rigid.size(); ++i) {
    const RigidBody& body = *bodies[group.rigid[i]].as<RigidBody>();
    const auto energy = [&](const Vec3& velocity, const Vec3& spin) {
      return 0.5 * (body.mass * velocity.squaredNorm() + spin.dot(body.world_inertia() * spin));
    };
    free += energy(body.velocity, body.angular_velocity());
    with += energy(body.velocity + s.delta_velocity[i], body.angular_velocity() + s.delta_angular_velocity[i]);
  }
  if (s.deformable.empty()) return {with - free, free};
  double won = 0.0;  // A holds elastic forces too: the work of the impulses
  for (std::size_t i = 0; i < s.contacts.size(); ++i)
    won += 0.5 * s.lambda[i].dot(s.contact_velocity(i, false) + s.contact_velocity(i, true));
  return {won, free};
}

bool ask_for_turning(GroupSystem& system, std::span<const double> end_gaps, std::span<const double> bounds,
                     const ContactSettings& settings, double time_step) {
  bool is_much = false;
  for (std::size_t i = 0; i < end_gaps.size(); ++i) {
    ContactRows& row = system.contacts[i];
    if (row.kind != RowKind::contact) continue;
    const double straight = row.gap + time_step * system.displacement_velocity(i).x();
    row.turning = std::min(end_gaps[i] - straight, 0.0);
    const double at_rest = row_bound({row.gap, 0.0, 0.0, 0.0, 0.0, row.scale.speed}, settings, time_step);
    row.bound = std::max(bounds[i], at_rest - row.turning / time_step);
    is_much |= row.turning < -kTurningTolerance * settings.activation_distance.at(row.scale.length);
  }
  return is_much;
}

}  // namespace impinge
