#include "viewer/draw/camera.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {

namespace {

constexpr double kDegree = M_PI / 180.0;

/// Any unit vector normal to v.
Vec3 some_normal(const Vec3& v) {
  int axis = 0;
  v.cwiseAbs().minCoeff(&axis);
  return Vec3::Unit(axis).cross(v).normalized();
}

}  // namespace

Mat3 Camera::view_rotation() const {
  const Vec3 line = eye - target;
  const Vec3 back = line.norm() > 0.0 ? Vec3(line.normalized()) : Vec3::UnitZ();
  Vec3 right = up.cross(back);
  right = right.norm() > 1e-9 * up.norm() ? Vec3(right.normalized()) : some_normal(back);
  Mat3 rows;
  rows << right.transpose(), back.cross(right).transpose(), back.transpose();
  return rows;
}

void Camera::orbit(double yaw_deg, double pitch_deg) {
  // a frame with `up` as its second axis, in which the eye's place is two angles
  const Vec3 pole = up.normalized(), first = std::abs(pole.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
  const Vec3 front = (first - pole * pole.dot(first)).normalized(), side = pole.cross(front);
  const Vec3 back = eye - target;
  const double radius = back.norm();
  if (radius == 0.0) return;
  const double yaw = std::atan2(back.dot(side), back.dot(front)) + yaw_deg * kDegree;
  double pitch = std::asin(std::clamp(back.dot(pole) / radius, -1.0, 1.0)) + pitch_deg * kDegree;
  pitch = std::clamp(pitch, -89.0 * kDegree, 89.0 * kDegree);
  eye = target + radius * (std::cos(pitch) * (std::cos(yaw) * front + std::sin(yaw) * side) + std::sin(pitch) * pole);
}

void Camera::pan(double right, double upwards) {
  const Mat3 axes = view_rotation();
  const Vec3 shift = right * axes.row(0).transpose() + upwards * axes.row(1).transpose();
  eye += shift;
  target += shift;
}

void Camera::zoom(double factor) { eye = target + (eye - target) / factor; }

void Camera::fit(const Aabb& box, double aspect) {
  if (box.is_empty()) return;
  const double half = 0.5 * fov_deg * kDegree, half_across = std::atan(std::tan(half) * aspect);
  const double radius = std::max(0.5 * box.extent().norm(), 1e-6);
  const Vec3 direction = view_rotation().row(2).transpose();
  target = box.center();
  eye = target + direction * radius / std::sin(std::min(half, half_across));
}

void Camera::take_in(std::span<const Vec3> points, double aspect) {
  constexpr double kUsed = 0.97;     // of the half picture: nothing sticks to its border
  constexpr double kNearest = 0.05;  // of the distance to the target
  const Mat3 axes = view_rotation();
  const double up_slope = kUsed * std::tan(0.5 * fov_deg * kDegree);
  const double slope[2] = {up_slope * aspect, up_slope};
  // at x across and d deep, from p across and s farther back: |x - p| <= (d + s) slope, for all x
  double high[2] = {0.0, 0.0}, low[2] = {0.0, 0.0}, back = 0.0;
  for (const Vec3& point : points) {
    const Vec3 seen = axes * (point - eye);
    const double depth = -seen.z();
    for (int a = 0; a < 2; ++a) {
      high[a] = std::max(high[a], seen[a] - depth * slope[a]);
      low[a] = std::min(low[a], seen[a] + depth * slope[a]);
    }
    back = std::max(back, kNearest * distance() - depth);
  }
  for (int a = 0; a < 2; ++a) back = std::max(back, (high[a] - low[a]) / (2.0 * slope[a]));
  Vec3 shift = back * axes.row(2).transpose();
  for (int a = 0; a < 2; ++a)
    shift += std::clamp(0.0, high[a] - back * slope[a], std::max(high[a] - back * slope[a], low[a] + back * slope[a])) *
             axes.row(a).transpose();
  eye += shift;
  target += shift;
}

double Camera::pixel_size_at(const Vec3& point, int height) const {
  const double depth = -(view_rotation() * (point - eye)).z();
  return depth > 0.0 ? 2.0 * depth * std::tan(0.5 * fov_deg * kDegree) / height : 0.0;
}

Vec3 Camera::unproject(double x, double y, double depth, int width, int height) const {
  const double pixel = 2.0 * depth * std::tan(0.5 * fov_deg * kDegree) / height;
  const Vec3 p((x - 0.5 * width) * pixel, (0.5 * height - y) * pixel, -depth);
  return eye + view_rotation().transpose() * p;
}

std::optional<Vec3> Camera::project(const Vec3& point, int width, int height) const {
  const Vec3 p = view_rotation() * (point - eye);
  if (p.z() >= 0.0) return std::nullopt;
  const double pixels = 0.5 * height / (std::tan(0.5 * fov_deg * kDegree) * -p.z());
  return Vec3(0.5 * width + p.x() * pixels, 0.5 * height - p.y() * pixels, -p.z());
}

}  // namespace impinge
