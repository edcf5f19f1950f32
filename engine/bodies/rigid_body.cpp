#include "engine/bodies/rigid_body.hpp"

#include <fmt/format.h>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {

void RigidBody::set_inertia(const Mat3& about_center) {
  principal = principal_inertia(about_center);
  inertia = principal.matrix();
  inertia_inverse = principal.inverse();
}

void RigidBody::find_free_velocity(const TimeIntegration& how) {
  apply_gravity(*this, how.gravity, how.time_step);
  if (pull) apply_pull(*this, *pull, how.time_step);
}

SystemBlock RigidBody::system_block() const {
  return RigidBlock{1.0 / mass, world_inertia_inverse(), velocity, angular_velocity()};
}

CarriedPoint RigidBody::carry(const MaterialPoint&, const Vec3& at) const {
  CarriedPoint carried;
  carried.arm = at - pose.position;
  carried.velocity_before = before_.linear + before_.angular.cross(carried.arm);
  return carried;
}

void RigidBody::change_velocity(const BodyVector& change) {
  velocity += change.twist.linear;
  angular_momentum += world_inertia() * change.twist.angular;
}

void RigidBody::advance(const TimeIntegration& how, double /*end*/) {
  try {
    advance_rigid(*this, how.time_step);
  } catch (const DivergenceError& error) {  // it knows no name
    throw DivergenceError(
        fmt::format("body '{}': {}; use more sub-steps, or smaller velocities and forces", name, error.what()));
  }
}

void RigidBody::displace(const BodyVector& by, const std::optional<Vec3>& group_velocity) {
  if (by.twist.is_zero()) return;
  displace_rigid(*this, by.twist.linear, by.twist.angular);
  if (group_velocity) angular_momentum -= by.twist.linear.cross(mass * (velocity - *group_velocity));
}

void RigidBody::stay(ByteReader& start) { restore_frame(start); }

void RigidBody::check_finite() const {
  // a maximum alone may pass over NaN
  const bool fine = pose.position.allFinite() && velocity.allFinite() &&
                    pose.position.cwiseAbs().maxCoeff() < kLargest && velocity.cwiseAbs().maxCoeff() < kLargest &&
                    angular_momentum.allFinite() && pose.rotation.allFinite();
  if (fine) return;
  throw DivergenceError(
      fmt::format("body '{}': position or velocity is no longer a finite number below {:g}; use more sub-steps, or "
                  "smaller velocities and forces",
                  name, kLargest));
}

void RigidBody::come_to_rest() {
  velocity.setZero();
  angular_momentum.setZero();
}

void RigidBody::push(const Vec3& impulse, const std::optional<Vec3>& at) {
  velocity += impulse / mass;
  if (at) angular_momentum += (*at - pose.position).cross(impulse);
}

void RigidBody::shift(const Vec3& by, const Mat3& turn) {
  const Vec3 w = angular_velocity();
  pose.position += by;
  pose.rotation = orthonormalized(turn * pose.rotation);
  angular_momentum = world_inertia() * w;
}

Balance RigidBody::balance(const Vec3& gravity) {
  const Vec3 p = mass * velocity;
  Balance own;
  own.kinetic = 0.5 * p.dot(velocity) + 0.5 * angular_momentum.dot(angular_velocity());
  own.potential = -(mass * gravity.dot(pose.position));
  own.momentum = p;
  own.angular_momentum = pose.position.cross(p) + angular_momentum;
  return own;
}

void RigidBody::restore(ByteReader& in) {
  const Frame frame = restore_frame(in);
  velocity = frame.velocity;
  angular_momentum = frame.angular_momentum;
}

}  // namespace impinge
