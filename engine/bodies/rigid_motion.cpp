#include "engine/bodies/rigid_motion.hpp"

#include <Eigen/Cholesky>

#include "engine/geometry/rotation.hpp"
#include "engine/rotation/free_rotation.hpp"

namespace impinge {
void apply_gravity(RigidBody& body, const Vec3& gravity, double kick) { body.velocity += kick * gravity; }

void apply_pull(RigidBody& body, const Pull& pull, double kick, double time_step) {
  const Vec3 at = body.position_of(pull.point), arm = at - body.pose.position;
  Mat3 across;  // across * x = arm × x
  across << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
  const Mat3 mobility = Mat3::Identity() / body.mass - across * body.world_inertia_inverse() * across;
  const Vec3 velocity = body.velocity + body.angular_velocity().cross(arm);
  // p = kick f(at + Δt v', v') with v' = velocity + mobility p
  const double m = pull.mass(kick, time_step);
  const Vec3 explicit_impulse = kick * pull.force(at + time_step * velocity, velocity);
  body.push((Mat3::Identity() + m * mobility).ldlt().solve(explicit_impulse), at);
}

Pose free_flight(const RigidBody& body, const Vec3& velocity, const Vec3& angular_momentum, double time_step) {
  Pose end = body.pose;
  end.position += time_step * velocity;
  end.rotation = free_turn(body, end.rotation, angular_momentum, time_step);
  return end;
}

Mat3 free_turn(const RigidBody& body, const Mat3& attitude, const Vec3& angular_momentum, double time_step) {
  if (angular_momentum.isZero(0.0)) return attitude;
  const Vec3 momentum = attitude.transpose() * angular_momentum;
  return orthonormalized(attitude * free_rotation(body.principal, momentum, time_step));
}

void advance_rigid(RigidBody& body, double time_step) {
  body.pose = free_flight(body, body.velocity, body.angular_momentum, time_step);
}

void displace_rigid(RigidBody& body, const Vec3& displacement, const Vec3& turn) {
  body.pose.position += displacement;
  body.pose.rotation = orthonormalized(rotation_exp(turn) * body.pose.rotation);
}

}  // namespace impinge
