// Attachments and sliding points of packed contacts, all of two bodies together.
#include "engine/response/packed_contacts.hpp"

#include <algorithm>
#include <utility>

namespace impinge {
namespace {

/// Whether some two of them share a body that moves.
bool share_bodies(const std::vector<JointBlock>& blocks, std::size_t bodies) {
  std::vector<char> is_met(bodies, 0);
  for (const JointBlock& block : blocks)
    for (const int body : {block.a, block.b})
      if (body >= 0 && std::exchange(is_met[static_cast<std::size_t>(body)], 1) != 0) return true;
  return false;
}

}  // namespace

bool PackedContacts::is_only_joined(const GroupSystem& group) {
  std::vector<char> is_attached(group.rigid.size(), 0);
  for (const ContactRows& row : group.contacts) {
    if (row.kind == RowKind::contact) return false;
    for (const int body : {row.a.rigid, row.b.rigid})
      if (body >= 0 && row.kind == RowKind::attachment) is_attached[static_cast<std::size_t>(body)] = 1;
  }
  return std::find(is_attached.begin(), is_attached.end(), 0) == is_attached.end();
}

void PackedContacts::add_joints(const GroupSystem& group, double share) {
  std::vector<JointBlock> blocks = joint_blocks(group);
  for (const JointBlock& block : blocks) add_joint(group, block, share);
  if (share_bodies(blocks, group.rigid.size())) all_joints_.emplace(group, std::move(blocks));
}

void PackedContacts::add_joint(const GroupSystem& group, const JointBlock& block, double share) {
  Joint joint{block.a, block.b, block.holds_points, {}, block.basis * block.basis.transpose()};
  joint.impulse.resize(static_cast<Eigen::Index>(block.rows.size()));
  joint.sum = VecX::Zero(joint.impulse.size());
  for (const JointBlock::Row& row : block.rows) {
    const ContactRows& of = group.contacts[row.contact];
    const Vec3 d = row.direction(of);
    joint.impulse[static_cast<Eigen::Index>(joint.rows.size())] = share * group.lambda[row.contact][row.k];
    joint.rows.push_back({static_cast<int>(row.contact), row.k, triple(d), triple(row.at_a(of).arm.cross(d)),
                          triple(row.at_b(of).arm.cross(d)), of.surface[row.k] - (row.k == 0 ? of.bound : 0.0)});
  }
  joints_.push_back(std::move(joint));
}

void PackedContacts::give(const Joint& joint, const VecX& impulse, std::vector<Body>& bodies) {
  Sides sides(bodies, joint.a, joint.b);
  for (Eigen::Index r = 0; r < impulse.size(); ++r) {
    const JointRow& row = joint.rows[r];
    add(sides.a.velocity, sides.a.inverse_mass * impulse[r], row.direction);
    add(sides.a.angular_velocity, impulse[r], times(sides.a.inverse_inertia, row.moment_a));
    add(sides.b.velocity, -sides.b.inverse_mass * impulse[r], row.direction);
    add(sides.b.angular_velocity, -impulse[r], times(sides.b.inverse_inertia, row.moment_b));
  }
}

VecX PackedContacts::missing(const Joint& joint, std::vector<Body>& bodies) {
  const Sides sides(bodies, joint.a, joint.b);
  VecX u(joint.impulse.size());
  for (Eigen::Index r = 0; r < u.size(); ++r) {
    const JointRow& row = joint.rows[r];
    u[r] = dot(row.direction, difference(sides.a.velocity, sides.b.velocity)) +
           dot(row.moment_a, sides.a.angular_velocity) - dot(row.moment_b, sides.b.angular_velocity) + row.surface;
  }
  return u;
}

void PackedContacts::relax_joints() {
  if (!all_joints_) {
    for (Joint& joint : joints_) add_impulse(joint, -(joint.inverse * missing(joint, bodies_)));
    return;
  }
  const std::vector<VecX> changes = answer_joints(bodies_);
  for (std::size_t j = 0; j < joints_.size(); ++j) add_impulse(joints_[j], changes[j]);
}

void PackedContacts::add_impulse(Joint& joint, const VecX& change) {
  joint.impulse += change;
  give(joint, change, bodies_);
}

std::vector<VecX> PackedContacts::answer_joints(std::vector<Body>& bodies) const {
  std::vector<Vec3> u(all_joints_->contacts().size(), Vec3::Zero());
  const auto at = [&](const JointRow& row) { return static_cast<std::size_t>(all_joints_->place(row.row)); };
  for (const Joint& joint : joints_) {
    const VecX own = missing(joint, bodies);
    for (Eigen::Index r = 0; r < own.size(); ++r) u[at(joint.rows[r])][joint.rows[r].k] = own[r];
  }
  const std::vector<Vec3> impulses = all_joints_->answer(u);
  std::vector<VecX> by_joint;
  for (const Joint& joint : joints_) {
    VecX& change = by_joint.emplace_back(joint.impulse.size());
    for (Eigen::Index r = 0; r < change.size(); ++r) change[r] = impulses[at(joint.rows[r])][joint.rows[r].k];
  }
  return by_joint;
}

void PackedContacts::keep_joined(GroupSystem& group) const {
  std::vector<Body> moved = bodies_;
  for (std::size_t b = 0; b < moved.size(); ++b) {
    add(moved[b].velocity, 1.0, triple(group.position_velocity[b]));
    add(moved[b].angular_velocity, 1.0, triple(group.position_angular_velocity[b]));
  }
  const std::vector<VecX> changes = answer_joints(moved);
  for (std::size_t j = 0; j < joints_.size(); ++j) give(joints_[j], changes[j], moved);
  for (std::size_t b = 0; b < moved.size(); ++b) {
    group.position_velocity[b] = vector(difference(moved[b].velocity, bodies_[b].velocity));
    group.position_angular_velocity[b] = vector(difference(moved[b].angular_velocity, bodies_[b].angular_velocity));
  }
}

}  // namespace impinge
