#include "engine/bodies/rigid_motion.hpp"

#include "engine/geometry/rotation.hpp"
#include "engine/rotation/free_rotation.hpp"

namespace impinge {
void apply_gravity(RigidBody& body, const Vec3& gravity, double time_step) { body.velocity += time_step * gravity; }

Pose free_flight(const RigidBody& body, const Vec3& velocity, const Vec3& angular_momentum, double time_step) {
  Pose end = body.pose;
  end.position += time_step * velocity;
  if (angular_momentum.isZero(0.0)) return end;
  const Vec3 momentum = end.rotation.transpose() * angular_momentum;
  end.rotation = orthonormalized(end.rotation * free_rotation(body.principal, momentum, time_step));
  return end;
}

void advance_rigid(RigidBody& body, double time_step) {
  body.pose = free_flight(body, body.velocity, body.angular_momentum, time_step);
}

void displace_rigid(RigidBody& body, const Vec3& displacement, const Vec3& turn) {
  body.pose.position += displacement;
  body.pose.rotation = orthonormalized(rotation_exp(turn) * body.pose.rotation);
}

}  // namespace impinge
