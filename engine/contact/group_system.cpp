#include "engine/contact/group_system.hpp"

namespace impinge {

Vec3 GroupSystem::contact_velocity(std::size_t i, bool with_delta) const {
  const ContactRows& rows = contacts[i];
  Vec3 relative = Vec3::Zero();
  const auto add = [&](int body, const Vec3& arm, double sign) {
    if (body < 0) return;
    Vec3 v = bodies[body].velocity, w = bodies[body].angular_velocity;
    if (with_delta) {
      v += delta_velocity[body];
      w += delta_angular_velocity[body];
    }
    relative += sign * (v + w.cross(arm));
  };
  add(rows.a, rows.arm_a, 1.0);
  add(rows.b, rows.arm_b, -1.0);
  return rows.directions * relative + rows.surface;
}

}  // namespace impinge
