#include "engine/integrators/rigid_motion.hpp"

#include "engine/geometry/rotation.hpp"

namespace impinge {

void apply_gravity(RigidBody& body, const Vec3& gravity, double time_step) { body.velocity += time_step * gravity; }

void advance_rigid(RigidBody& body, double time_step) {
  body.pose.position += time_step * body.velocity;
  if (body.angular_momentum.isZero(0.0)) return;
  // fixed point for the midpoint angular velocity: contracts by about (Δt |w|)/2, so a handful of rounds reach rounding
  const Mat3 start = body.pose.rotation;
  const auto angular_velocity = [&](const Mat3& r) {
    return Vec3(r * (body.inertia_inverse * (r.transpose() * body.angular_momentum)));
  };
  Vec3 w = angular_velocity(start);
  for (int i = 0; i < 50; ++i) {
    const Vec3 next = angular_velocity(rotation_exp(0.5 * time_step * w) * start);
    const bool settled = (next - w).norm() <= 1e-15 * next.norm();
    w = next;
    if (settled) break;
  }
  body.pose.rotation = orthonormalized(rotation_exp(time_step * w) * start);
}

void displace_rigid(RigidBody& body, const Vec3& displacement, const Vec3& turn) {
  body.pose.position += displacement;
  body.pose.rotation = orthonormalized(rotation_exp(turn) * body.pose.rotation);
}

}  // namespace impinge
