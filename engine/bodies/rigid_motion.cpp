#include "engine/bodies/rigid_motion.hpp"

#include "engine/geometry/rotation.hpp"
#include "engine/rotation/free_rotation.hpp"

namespace impinge {
void apply_gravity(RigidBody& body, const Vec3& gravity, double time_step) { body.velocity += time_step * gravity; }

void advance_rigid(RigidBody& body, double time_step) {
  body.pose.position += time_step * body.velocity;
  if (body.angular_momentum.isZero(0.0)) return;
  const Vec3 momentum = body.pose.rotation.transpose() * body.angular_momentum;
  body.pose.rotation = orthonormalized(body.pose.rotation * free_rotation(body.principal, momentum, time_step));
}

void displace_rigid(RigidBody& body, const Vec3& displacement, const Vec3& turn) {
  body.pose.position += displacement;
  body.pose.rotation = orthonormalized(rotation_exp(turn) * body.pose.rotation);
}

}  // namespace impinge
