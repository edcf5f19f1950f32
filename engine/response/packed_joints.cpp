// Attachments and sliding points of packed contacts, all of two bodies together.
#include "engine/response/packed_contacts.hpp"

namespace impinge {

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

void PackedContacts::give(const Joint& joint, const VecX& impulse) {
  Sides sides(bodies_, joint.a, joint.b);
  for (Eigen::Index r = 0; r < impulse.size(); ++r) {
    const JointRow& row = joint.rows[r];
    add(sides.a.velocity, sides.a.inverse_mass * impulse[r], row.direction);
    add(sides.a.angular_velocity, impulse[r], times(sides.a.inverse_inertia, row.moment_a));
    add(sides.b.velocity, -sides.b.inverse_mass * impulse[r], row.direction);
    add(sides.b.angular_velocity, -impulse[r], times(sides.b.inverse_inertia, row.moment_b));
  }
}

void PackedContacts::relax(Joint& joint) {
  const Sides sides(bodies_, joint.a, joint.b);
  VecX u(joint.impulse.size());
  for (Eigen::Index r = 0; r < u.size(); ++r) {
    const JointRow& row = joint.rows[r];
    u[r] = dot(row.direction, difference(sides.a.velocity, sides.b.velocity)) +
           dot(row.moment_a, sides.a.angular_velocity) - dot(row.moment_b, sides.b.angular_velocity) + row.surface;
  }
  const VecX change = -(joint.inverse * u);
  joint.impulse += change;
  give(joint, change);
}

}  // namespace impinge
