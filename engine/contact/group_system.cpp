#include "engine/contact/group_system.hpp"

namespace impinge {

Vec3 GroupSystem::contact_velocity(std::size_t i, bool with_delta) const {
  const ContactRows& rows = contacts[i];
  Vec3 relative = Vec3::Zero();
  const auto add = [&](const ContactSide& side, double sign) {
    if (side.rigid >= 0) {
      Vec3 v = bodies[side.rigid].velocity, w = bodies[side.rigid].angular_velocity;
      if (with_delta) {
        v += delta_velocity[side.rigid];
        w += delta_angular_velocity[side.rigid];
      }
      relative += sign * (v + w.cross(side.arm));
    }
    for (const NodeWeight& n : side.nodes) {
      const SoftBlock& block = soft[side.soft];
      Vec3 v = block.velocity.segment<3>(3 * n.node);
      if (with_delta) v += block.scale * soft_delta[side.soft].segment<3>(3 * n.node);
      relative += sign * n.weight * v;
    }
  };
  add(rows.a, 1.0);
  add(rows.b, -1.0);
  return rows.directions * relative + rows.surface;
}

VecX GroupSystem::soft_impulse(int body, const std::vector<Vec3>& impulses) const {
  VecX sum = VecX::Zero(soft[body].velocity.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 force = contacts[i].directions.transpose() * impulses[i];
    for (const auto& [side, sign] : {std::pair(&contacts[i].a, 1.0), std::pair(&contacts[i].b, -1.0)})
      if (side->soft == body)
        for (const NodeWeight& n : side->nodes) sum.segment<3>(3 * n.node) += sign * n.weight * force;
  }
  return sum;
}

void GroupSystem::clear_delta() {
  delta_velocity.assign(bodies.size(), Vec3::Zero());
  delta_angular_velocity.assign(bodies.size(), Vec3::Zero());
  soft_delta.clear();
  for (const SoftBlock& block : soft) soft_delta.push_back(VecX::Zero(block.velocity.size()));
}

}  // namespace impinge
