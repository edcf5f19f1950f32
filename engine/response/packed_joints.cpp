// Attachments and sliding points of packed contacts, all of two bodies together.
#include <Eigen/QR>
#include <algorithm>

#include "engine/response/packed_contacts.hpp"

namespace impinge {
namespace {

// of W: what rows of a joint hold together no better than this they don't hold
constexpr double kNoHold = 1e-9;

}  // namespace

void PackedContacts::add_to_joint(const GroupSystem& group, std::size_t row, double share) {
  const ContactRows& of = group.contacts[row];
  auto joint = std::find_if(joints_.begin(), joints_.end(),
                            [&](const Joint& known) { return known.a == of.a.rigid && known.b == of.b.rigid; });
  if (joint == joints_.end()) joint = joints_.insert(joint, Joint{of.a.rigid, of.b.rigid});
  if (of.kind == RowKind::attachment) joint->holds_points = true;
  const auto before = joint->impulse.size();
  const int count = of.kind == RowKind::sliding ? 1 : 3;
  joint->impulse.conservativeResize(before + count);
  for (int k = 0; k < count; ++k) {
    const Vec3 d = of.directions.row(k);
    joint->rows.push_back({static_cast<int>(row), k, triple(d), triple(of.a.arm.cross(d)), triple(of.b.arm.cross(d)),
                           of.surface[k] - (k == 0 ? of.bound : 0.0)});
    joint->impulse[before + k] = share * group.lambda[row][k];
  }
}

/// W of its rows, inverted where it can be: two points hold a body in five ways, not in six.
void PackedContacts::close(Joint& joint) {
  const auto count = static_cast<Eigen::Index>(joint.rows.size());
  const Sides sides(bodies_, joint.a, joint.b);
  MatX w(count, count);
  for (Eigen::Index r = 0; r < count; ++r)
    for (Eigen::Index c = 0; c < count; ++c) {
      const JointRow &of = joint.rows[r], &other = joint.rows[c];
      w(r, c) = (sides.a.inverse_mass + sides.b.inverse_mass) * dot(of.direction, other.direction) +
                dot(of.moment_a, times(sides.a.inverse_inertia, other.moment_a)) +
                dot(of.moment_b, times(sides.b.inverse_inertia, other.moment_b));
    }
  Eigen::CompleteOrthogonalDecomposition<MatX> factors(w);
  factors.setThreshold(kNoHold);
  joint.inverse = factors.pseudoInverse();
  joint.sum = VecX::Zero(count);
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
