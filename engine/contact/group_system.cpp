#include "engine/contact/group_system.hpp"

namespace impinge {

namespace {

/// J of contact i times the rigid bodies' velocities and what `node_velocity(side, node)` says of deformable ones.
template <class NodeVelocity>
Vec3 row_velocity(const GroupSystem& group, std::size_t i, bool with_delta, NodeVelocity node_velocity) {
  const ContactRows& rows = group.contacts[i];
  Vec3 relative = Vec3::Zero();
  const auto add = [&](const ContactSide& side, double sign) {
    if (side.rigid >= 0) {
      Vec3 v = group.rigid[side.rigid].velocity, w = group.rigid[side.rigid].angular_velocity;
      if (with_delta) {
        v += group.delta_velocity[side.rigid];
        w += group.delta_angular_velocity[side.rigid];
      }
      relative += sign * (v + w.cross(side.arm));
    }
    for (const NodeWeight& n : side.nodes) relative += sign * n.weight * node_velocity(side.deformable, n.node);
  };
  add(rows.a, 1.0);
  add(rows.b, -1.0);
  return rows.directions * relative + rows.surface;
}

Vec3 node_displacement(const GroupSystem& group, int body, int node) {
  const DeformableBlock& block = group.deformable[body];
  return block.displacement_velocity.segment<3>(3 * node) +
         block.displacement_scale * group.deformable_delta[body].segment<3>(3 * node);
}

}  // namespace

Vec3 GroupSystem::contact_velocity(std::size_t i, bool with_delta) const {
  return row_velocity(*this, i, with_delta, [&](int body, int node) {
    const Vec3 v = deformable[body].velocity.segment<3>(3 * node);
    return with_delta ? Vec3(v + deformable_delta[body].segment<3>(3 * node)) : v;
  });
}

Vec3 GroupSystem::displacement_velocity(std::size_t i) const {
  return row_velocity(*this, i, true, [&](int body, int node) { return node_displacement(*this, body, node); });
}

Vec3 GroupSystem::displacement_velocity(const ContactSide& side) const {
  Vec3 velocity = side.driven;
  for (const NodeWeight& n : side.nodes) velocity += n.weight * node_displacement(*this, side.deformable, n.node);
  return velocity;
}

VecX GroupSystem::deformable_impulse(int body, const std::vector<Vec3>& impulses) const {
  VecX sum = VecX::Zero(deformable[body].velocity.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 force = contacts[i].directions.transpose() * impulses[i];
    for (const auto& [side, sign] : {std::pair(&contacts[i].a, 1.0), std::pair(&contacts[i].b, -1.0)})
      if (side->deformable == body)
        for (const NodeWeight& n : side->nodes) sum.segment<3>(3 * n.node) += sign * n.weight * force;
  }
  return sum;
}

void GroupSystem::clear_delta() {
  delta_velocity.assign(rigid.size(), Vec3::Zero());
  delta_angular_velocity.assign(rigid.size(), Vec3::Zero());
  deformable_delta.clear();
  for (const DeformableBlock& block : deformable) deformable_delta.push_back(VecX::Zero(block.velocity.size()));
}

GroupSystem GroupSystem::without(const std::vector<char>& out) const {
  GroupSystem rest;
  rest.rigid = rigid, rest.deformable = deformable;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] == 0) rest.contacts.push_back(contacts[i]), rest.lambda.push_back(lambda[i]);
  rest.clear_delta();
  return rest;
}

}  // namespace impinge
