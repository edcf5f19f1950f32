// A camera as single-precision matrices. World points are first taken relative to the eye in double precision, so that
// small things far from the origin keep their place.
#pragma once

#include <vector>

#include "viewer/draw/camera.hpp"
#include "viewer/draw/draw_list.hpp"

namespace impinge {

struct ViewTransform {
  Vec3 eye = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();  ///< world directions to the eye's axes
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();
  Eigen::Vector3f eye_up = Eigen::Vector3f::UnitY();
  double near = 0.01, far = 100.0;  ///< metres
  double focal = 1.0;               ///< pixels: an object of one metre at one metre
  /// Metres from the eye to what is looked at: the target, or what is drawn or a floor where all of that is beyond it.
  double distance = 1.0;
  double floor_radius = 1.0;  ///< metres round the target within which floors are drawn: all that stands on them is
  int width = 0, height = 0;

  Eigen::Vector3f to_eye(const Vec3& point) const { return (rotation * (point - eye)).cast<float>(); }
  Eigen::Matrix4f model_view(const Pose& pose) const;
};

/// `bounds`: of everything drawn but planes; the depth range is no longer than it needs.
ViewTransform make_view_transform(const Camera& camera, const Aabb& bounds, const std::vector<DrawPlane>& planes,
                                  int width, int height);

}  // namespace impinge
