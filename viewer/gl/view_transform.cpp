#include "viewer/gl/view_transform.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {

namespace {

/// In four steps an octave, so that depths keep their measure while bodies move.
template <class Round>
double in_steps(double length, Round&& round) {
  return length > 0.0 ? std::exp2(0.25 * round(4.0 * std::log2(length))) : length;
}

}  // namespace

Eigen::Matrix4f ViewTransform::model_view(const Pose& pose) const {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = (rotation * pose.rotation).cast<float>();
  m.topRightCorner<3, 1>() = to_eye(pose.position);
  return m;
}

ViewTransform make_view_transform(const Camera& camera, const Aabb& bounds, int width, int height) {
  ViewTransform view;
  view.eye = camera.eye;
  view.rotation = camera.view_rotation();
  view.eye_up = (view.rotation * camera.up.normalized()).cast<float>();
  view.width = width;
  view.height = height;
  const double distance = std::max(camera.distance(), 1e-9);
  double nearest = distance, farthest = distance;
  for (int corner = 0; corner < 8 && !bounds.is_empty(); ++corner) {
    const Vec3 p(corner & 1 ? bounds.max.x() : bounds.min.x(), corner & 2 ? bounds.max.y() : bounds.min.y(),
                 corner & 4 ? bounds.max.z() : bounds.min.z());
    const double depth = -(view.rotation * (p - view.eye)).z();
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // 24 bits: a near plane at 1/1000 of the far one still tells depths of 1e-4 apart at the far end
  view.far = in_steps(1.1 * farthest + 3.0 * distance, [](double x) { return std::ceil(x); });
  view.near = std::clamp(in_steps(0.7 * nearest, [](double x) { return std::floor(x); }),
                         std::max(1e-4 * view.far, 0.01 * distance), 0.5 * distance);
  const double tangent = std::tan(0.5 * camera.fov_deg * M_PI / 180.0);
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
