#include "viewer/gl/view_transform.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace impinge {

namespace {

/// In four steps an octave, so that depths keep their measure while bodies move.
template <class Round>
double in_steps(double length, Round&& round) {
  return length > 0.0 ? std::exp2(0.25 * round(4.0 * std::log2(length))) : length;
}

/// Depth of the nearest point of a floor that is in the picture; nothing of one that is seen from below or not at all.
/// `slope`: of the picture's border, across and up.
std::optional<double> nearest_depth(const DrawPlane& plane, const ViewTransform& view, const Vec3& slope) {
  const double height = plane.normal.dot(view.eye) - plane.offset;
  if (height <= 0.0) return std::nullopt;
  // how fast one comes down to it along a line of sight, per depth: fastest in a corner of the picture
  const Vec3 down = -(view.rotation * plane.normal);
  const double fastest = std::abs(down.x()) * slope.x() + std::abs(down.y()) * slope.y() - down.z();
  if (fastest <= 0.0) return std::nullopt;
  return height / fastest;
}

}  // namespace

Eigen::Matrix4f ViewTransform::model_view(const Pose& pose) const {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = (rotation * pose.rotation).cast<float>();
  m.topRightCorner<3, 1>() = to_eye(pose.position);
  return m;
}

ViewTransform make_view_transform(const Camera& camera, const Aabb& bounds, const std::vector<DrawPlane>& planes,
                                  int width, int height) {
  ViewTransform view;
  view.eye = camera.eye;
  view.rotation = camera.view_rotation();
  view.eye_up = (view.rotation * camera.up.normalized()).cast<float>();
  view.width = width;
  view.height = height;
  const double distance = std::max(camera.distance(), 1e-9);
  const double tangent = std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
  double nearest = distance, farthest = distance, first = HUGE_VAL, reach = 0.0;
  for (int corner = 0; corner < 8 && !bounds.is_empty(); ++corner) {
    const Vec3 p(corner & 1 ? bounds.max.x() : bounds.min.x(), corner & 2 ? bounds.max.y() : bounds.min.y(),
                 corner & 4 ? bounds.max.z() : bounds.min.z());
    const double depth = -(view.rotation * (p - view.eye)).z();
    first = std::min(first, depth);
    farthest = std::max(farthest, depth);
    reach = std::max(reach, (p - camera.target).norm());
  }
  nearest = std::min(nearest, first);
  const auto up = [](double x) { return std::ceil(x); };
  const auto down = [](double x) { return std::floor(x); };
  view.distance = distance;
  if (first > distance && std::isfinite(first)) view.distance = std::max(distance, in_steps(first, down));
  for (const DrawPlane& plane : planes)  // a floor far below is looked at as well
    view.distance = std::max(view.distance, in_steps((plane.normal.dot(view.eye) - plane.offset) / 1.5, down));
  // a floor is whole within a third of that radius, and faint at two thirds
  view.floor_radius = 2.2 * view.distance;
  if (reach > 0.65 * view.floor_radius) view.floor_radius = in_steps(reach / 0.65, up);
  if (!planes.empty() && view.floor_radius > 2.2 * distance)
    farthest = std::max(farthest, distance + view.floor_radius);
  // 24 bits: a near plane at 1/1000 of the far one still tells depths of 1e-4 apart at the far end
  view.far = in_steps(1.1 * farthest + 3.0 * distance, up);
  view.near = std::clamp(in_steps(0.7 * nearest, down), std::max(1e-4 * view.far, 0.01 * distance), 0.5 * distance);
  for (const DrawPlane& plane : planes)
    if (const auto depth = nearest_depth(plane, view, Vec3(tangent * width / height, tangent, 0.0));
        depth && *depth < view.near)
      view.near = std::max(in_steps(0.95 * *depth, down), 1e-4 * view.far);
  view.focal = 0.5 * height / tangent;
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  p(0, 0) = height / (tangent * width);
  p(1, 1) = 1.0 / tangent;
  p(2, 2) = -(view.far + view.near) / (view.far - view.near);
  p(2, 3) = -2.0 * view.far * view.near / (view.far - view.near);
  p(3, 2) = -1.0;
  view.projection = p.cast<float>();
  return view;
}

}  // namespace impinge
