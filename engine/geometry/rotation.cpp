#include "engine/geometry/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {
constexpr double kRadians = M_PI / 180.0;
}

Mat3 rotation_from_degrees(const Vec3& degrees) {
  const Vec3 r = degrees * kRadians;
  return (Eigen::AngleAxisd(r.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(r.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(r.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

Vec3 degrees_from_rotation(const Mat3& m) {
  const double y = std::asin(std::clamp(-m(2, 0), -1.0, 1.0));
  if (std::abs(m(2, 0)) > 1.0 - 1e-14)  // gimbal lock: only x -+ z is determined, so z = 0
    return Vec3(std::atan2(-m(1, 2), m(1, 1)), y, 0.0) / kRadians;
  return Vec3(std::atan2(m(2, 1), m(2, 2)), y, std::atan2(m(1, 0), m(0, 0))) / kRadians;
}

Mat3 rotation_exp(const Vec3& w) {
  const double angle2 = w.squaredNorm(), angle = std::sqrt(angle2);
  // the series keep full precision where sin(x)/x loses it
  const double a = angle < 1e-4 ? 1.0 - angle2 / 6.0 : std::sin(angle) / angle;
  const double b = angle < 1e-4 ? 0.5 - angle2 / 24.0 : (1.0 - std::cos(angle)) / angle2;
  Mat3 k;
  k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return Mat3::Identity() + a * k + b * k * k;
}

Pose moved(const Pose& pose, const Vec3& shift, const Vec3& turn) {
  return {turn.isZero(0.0) ? pose.rotation : Mat3(rotation_exp(turn) * pose.rotation), pose.position + shift};
}

Vec3 rotation_log(const Mat3& rotation) {
  Quat q(rotation);
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double s = q.vec().norm();
  if (s < 1e-12) return 2.0 * q.vec();
  return 2.0 * std::atan2(s, q.w()) / s * q.vec();
}

Mat3 orthonormalized(const Mat3& rotation) { return Quat(rotation).normalized().toRotationMatrix(); }

}  // namespace impinge
