#include "engine/contact/recovery/passive_share.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/rigid_body.hpp"

namespace impinge {

double passive_share(const Bodies& bodies, const AssembledGroup& without, const AssembledGroup& with) {
  // of the motion with a share s: rest + s slope + s² curve / 2; free: of the free velocities
  const GroupSystem &before = without.system, &after = with.system;
  double free = 0.0, rest = 0.0, slope = 0.0, curve = 0.0;
  for (std::size_t i = 0; i < without.rigid.size(); ++i) {
    const RigidBody& body = *bodies[without.rigid[i]].as<RigidBody>();
    const Mat3 inertia = body.world_inertia();
    const Vec3 v = body.velocity, w = body.angular_velocity(), v0 = before.rigid[i].velocity + before.delta_velocity[i],
               w0 = before.rigid[i].angular_velocity + before.delta_angular_velocity[i],
               dv = after.delta_velocity[i] - before.delta_velocity[i],
               dw = after.delta_angular_velocity[i] - before.delta_angular_velocity[i];
    free += 0.5 * (body.mass * v.squaredNorm() + w.dot(inertia * w));
    rest += 0.5 * (body.mass * v0.squaredNorm() + w0.dot(inertia * w0));
    slope += body.mass * v0.dot(dv) + w0.dot(inertia * dw);
    curve += body.mass * dv.squaredNorm() + dw.dot(inertia * dw);
  }
  if (!(curve > 0.0)) return 1.0;
  const double budget = std::max(0.0, free - rest);
  return std::clamp((-slope + std::sqrt(slope * slope + 2.0 * curve * budget)) / curve, 0.0, 1.0);
}

void ask_for_share(AssembledGroup& group, double share, double time_step) {
  group.drift.resize(group.contacts.size(), Vec3::Zero());
  for (std::size_t i = 0; i < group.recovery.size(); ++i) {
    const Vec3 left = (1.0 - share) * group.recovery[i];
    ContactRows& rows = group.system.contacts[i];
    rows.surface -= rows.directions * left;
    group.recovery[i] -= left;
    group.drift[i] += time_step * left;
  }
}

}  // namespace impinge
