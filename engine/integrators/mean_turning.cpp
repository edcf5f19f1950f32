#include "engine/integrators/mean_turning.hpp"

#include <Eigen/LU>
#include <cmath>

#include "engine/bodies/deformable_body.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {

Vec3 mean_turning(const DeformableBody& body) {
  const Vec3 center = body.center_of_mass();
  VecX arms = body.position, weighted;
  for (int i = 0; i < body.nodes(); ++i) arms.segment<3>(3 * i) -= center;
  body.fem.multiply_mass(arms, weighted);
  Mat3 inertia = Mat3::Zero();
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec3 arm = arms.segment<3>(3 * i), mass_arm = weighted.segment<3>(3 * i);
    inertia += arm.dot(mass_arm) * Mat3::Identity() - mass_arm * arm.transpose();
  }
  const Vec3 spin = body.angular_momentum() - center.cross(body.momentum());
  return inertia.inverse() * spin;
}

VecX rigid_motion(const DeformableBody& body, double h, TurningRule rule) {
  if (body.free_nodes() < body.nodes()) return {};
  const Vec3 center = body.center_of_mass(), omega = mean_turning(body), drift = body.momentum() / body.mass;
  if (!omega.allFinite()) return {};
  const double angle = h * omega.norm(), turned = rule == TurningRule::exact ? angle : 2.0 * std::atan(0.5 * angle);
  const Mat3 turn = rotation_exp(angle > 0.0 ? Vec3(turned / angle * h * omega) : Vec3::Zero());
  VecX v(body.position.size());
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec3 arm = Vec3(body.position.segment<3>(3 * i)) - center;
    v.segment<3>(3 * i) = drift + (turn * arm - arm) / h;
  }
  return v;
}

}  // namespace impinge
