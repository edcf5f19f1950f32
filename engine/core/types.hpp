// The few types everything shares. All quantities are SI: metres, kilograms, seconds, radians; world axes, y up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace impinge {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;
using VecX = Eigen::VectorXd;
using MatX = Eigen::MatrixXd;
using Quat = Eigen::Quaterniond;

/// Corner indices of a triangle, counter-clockwise seen from outside.
using Triangle = std::array<int, 3>;

/// m x, written out: compilers leave Eigen's own product of this size as a call, which took a fifth of detection. Sums
/// are Eigen's to the bit.
inline Vec3 product(const Mat3& m, const Vec3& x) {
  return {(m(0, 0) * x.x() + m(0, 1) * x.y()) + m(0, 2) * x.z(), (m(1, 0) * x.x() + m(1, 1) * x.y()) + m(1, 2) * x.z(),
          m(2, 0) * x.x() + (m(2, 1) * x.y() + m(2, 2) * x.z())};
}

/// A rigid pose: x_world = rotation * x_local + position. The rotation is kept orthonormal by whoever changes it.
struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 position = Vec3::Zero();

  Vec3 apply(const Vec3& local) const { return product(rotation, local) + position; }
  Vec3 apply_inverse(const Vec3& world) const { return rotation.transpose() * (world - position); }
};

}  // namespace impinge
