#include "engine/response/rigid_delassus.hpp"

namespace impinge {

RigidDelassus::RigidDelassus(GroupSystem& group) : group_(group), diagonal_(group.contacts.size(), Mat3::Zero()), sides_(group.contacts.size()) {
  group.delta_velocity.assign(group.bodies.size(), Vec3::Zero());
  group.delta_angular_velocity.assign(group.bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const ContactRows& rows = group.contacts[i];
    const auto side = [&](int body, const Vec3& arm, double sign, Side& out) {
      if (body < 0) return;
      const BodyBlock& block = group.bodies[body];
      for (int k = 0; k < 3; ++k) out.arm.row(k) = sign * arm.cross(rows.directions.row(k).transpose()).transpose();
      out.linear = sign * block.inverse_mass * rows.directions.transpose();
      out.angular = block.inverse_inertia * out.arm.transpose();
      diagonal_[i] += block.inverse_mass * (rows.directions * rows.directions.transpose()) + out.arm * out.angular;
    };
    side(rows.a, rows.arm_a, 1.0, sides_[i][0]);
    side(rows.b, rows.arm_b, -1.0, sides_[i][1]);
  }
}

void RigidDelassus::begin(const std::vector<Vec3>& lambda) {
  for (Vec3& v : group_.delta_velocity) v.setZero();
  for (Vec3& w : group_.delta_angular_velocity) w.setZero();
  for (std::size_t i = 0; i < lambda.size(); ++i)
    if (!lambda[i].isZero(0.0)) change(i, lambda[i], group_.contacts[i].friction == 0.0);
}

Vec3 RigidDelassus::row(std::size_t i, bool normal_only) const {
  const ContactRows& rows = group_.contacts[i];
  Vec3 relative = Vec3::Zero();
  if (rows.a >= 0) relative += group_.delta_velocity[rows.a];
  if (rows.b >= 0) relative -= group_.delta_velocity[rows.b];
  if (normal_only) {
    double u = rows.directions.row(0).dot(relative);
    if (rows.a >= 0) u += sides_[i][0].arm.row(0).dot(group_.delta_angular_velocity[rows.a]);
    if (rows.b >= 0) u += sides_[i][1].arm.row(0).dot(group_.delta_angular_velocity[rows.b]);
    return {u, 0.0, 0.0};
  }
  Vec3 u = rows.directions * relative;
  if (rows.a >= 0) u += sides_[i][0].arm * group_.delta_angular_velocity[rows.a];
  if (rows.b >= 0) u += sides_[i][1].arm * group_.delta_angular_velocity[rows.b];
  return u;
}

void RigidDelassus::change(std::size_t i, const Vec3& delta, bool normal_only) {
  const ContactRows& rows = group_.contacts[i];
  const int body[2] = {rows.a, rows.b};
  for (int s = 0; s < 2; ++s) {
    if (body[s] < 0) continue;
    const Side& side = sides_[i][s];
    if (normal_only) {
      group_.delta_velocity[body[s]] += side.linear.col(0) * delta.x();
      group_.delta_angular_velocity[body[s]] += side.angular.col(0) * delta.x();
    } else {
      group_.delta_velocity[body[s]] += side.linear * delta;
      group_.delta_angular_velocity[body[s]] += side.angular * delta;
    }
  }
}

}  // namespace impinge
