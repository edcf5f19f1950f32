#include "engine/step/late_impacts.hpp"

#include <algorithm>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {
namespace {

/// Of row n, for bodies that are displaced so.
double along_normal(const ContactRows& row, const LateImpacts& by) {
  const auto of = [&](const ContactSide& side) {
    return side.rigid < 0 ? Vec3(Vec3::Zero())
                          : Vec3(by.linear[static_cast<std::size_t>(side.rigid)] +
                                 by.angular[static_cast<std::size_t>(side.rigid)].cross(side.arm));
  };
  return row.directions.row(0).dot(of(row.a) - of(row.b));
}

}  // namespace

std::optional<LateImpacts> late_impacts(const GroupSystem& solved, double time_step) {
  const auto is_late = [](const ContactRows& row) { return row.impact > 0.0; };
  if (!solved.deformable.empty() || std::none_of(solved.contacts.begin(), solved.contacts.end(), is_late))
    return std::nullopt;
  LateImpacts by;
  by.linear.assign(solved.rigid.size(), Vec3::Zero());
  by.angular = by.linear;
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& row = solved.contacts[i];
    if (!is_late(row)) continue;
    const Vec3 impulse = row.directions.transpose() * solved.lambda[i];
    for (const auto& [side, sign] : {std::pair(&row.a, -1.0), std::pair(&row.b, 1.0)}) {
      if (side->rigid < 0) continue;
      const auto b = static_cast<std::size_t>(side->rigid);
      const Vec3 late = sign * row.impact * impulse;
      by.linear[b] += solved.rigid[b].inverse_mass * late;
      by.angular[b] += solved.rigid[b].inverse_inertia * side->arm.cross(late);
    }
  }
  double share = 1.0;
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& row = solved.contacts[i];
    if (row.kind != RowKind::contact) continue;
    const double end = row.gap + row.turning + time_step * solved.displacement_velocity(i).x(),
                 more = along_normal(row, by);
    if (more < 0.0 && end + more < 0.0) share = std::min(share, std::max(end, 0.0) / -more);
  }
  for (Vec3& v : by.linear) v *= share;
  for (Vec3& v : by.angular) v *= share;
  return by;
}

std::vector<char> struck_bodies(const AssembledGroup& group, const CollisionGroup& of, const ContactList& contacts,
                                const ContactSettings& settings) {
  std::vector<char> struck(of.bodies.size(), 0);
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& row = group.system.contacts[i];
    if (row.kind != RowKind::contact || !(group.system.lambda[i].x() > 0.0)) continue;
    if (row.velocity_before > -settings.restitution_threshold.at(row.scale.speed)) continue;
    const auto [a, b] = contacts.bodies(group.contacts[i]);
    for (std::size_t k = 0; k < struck.size(); ++k)
      if (of.bodies[k] == a || of.bodies[k] == b) struck[k] = 1;
  }
  return struck;
}

GroupSystem without_meeting(const GroupSystem& system) {
  std::vector<char> later;
  for (const ContactRows& row : system.contacts) later.push_back(row.impact > 0.0);
  return system.without(later);
}

std::vector<Vec3> spins_as_they_stand(const Bodies& bodies, const AssembledGroup& group, std::vector<Vec3> changes) {
  for (std::size_t i = 0; i < changes.size(); ++i)
    changes[i] = bodies[group.rigid[i]].as<RigidBody>()->world_inertia_inverse() *
                 (group.system.rigid[i].inverse_inertia.inverse() * changes[i]);
  return changes;
}

LateImpacts ways_until_meeting(const Bodies& bodies, const AssembledGroup& group, const GroupSystem& before,
                               double time_step) {
  const double met = group.meeting;
  LateImpacts ways;
  for (std::size_t i = 0; i < group.rigid.size(); ++i) {
    const RigidBody& body = *bodies[group.rigid[i]].as<RigidBody>();
    const RigidBlock& then = group.system.rigid[i];
    const Mat3 &start = body.pose.rotation, inertia = then.inverse_inertia.inverse();
    const Vec3 momentum = body.angular_momentum, first = momentum + inertia * before.delta_angular_velocity[i],
               last = momentum + inertia * group.system.delta_angular_velocity[i];
    const Mat3 taken = free_turn(body, start, last, time_step),
               wanted = free_turn(body, free_turn(body, start, first, met), last, time_step - met);
    ways.linear.push_back(met * (before.delta_velocity[i] - group.system.delta_velocity[i]));
    ways.angular.push_back(rotation_log(wanted * taken.transpose()));
  }
  return ways;
}

}  // namespace impinge
