// The eye of the view. Plain geometry in double precision: no OpenGL, no pictures.
#pragma once

#include <optional>
#include <span>

#include "engine/geometry/aabb.hpp"

namespace impinge {

struct Camera {
  Vec3 eye{3.0, 2.0, 4.0};
  Vec3 target{0.0, 0.5, 0.0};
  Vec3 up = Vec3::UnitY();  ///< which way is up for orbit; need not be normal to the line of sight
  double fov_deg = 40.0;    ///< vertical angle of view

  void look_at(const Vec3& from, const Vec3& to) { eye = from, target = to; }
  /// Turns the eye about the target: yaw about `up` (positive: eye moves to the right), pitch towards `up`; kept 1°
  /// away from the poles, where `up` would lose its meaning.
  void orbit(double yaw_deg, double pitch_deg);
  /// Moves eye and target, in metres to the right and up as seen.
  void pan(double right, double upwards);
  /// Divides the distance to the target.
  void zoom(double factor);
  /// Looks at the middle of the box from the present direction, near enough that the box's sphere just fits a picture
  /// of that aspect (width / height). Does nothing for an empty box.
  void fit(const Aabb& box, double aspect = 16.0 / 9.0);

  /// Goes back along its line of sight, and across it, no farther than it takes to have these points, and what it had
  /// before at the target's depth, in a picture of that aspect. Stays where it is if they are in it.
  void take_in(std::span<const Vec3> points, double aspect);

  double distance() const { return (eye - target).norm(); }
  /// Rows: right, up, backwards. Maps world directions to the eye's axes (it looks along -z).
  Mat3 view_rotation() const;
  /// Metres that one pixel spans at a world point, across the line of sight; 0 behind the eye.
  double pixel_size_at(const Vec3& point, int height) const;
  /// The point that appears at a pixel, at this distance along the line of sight: project's inverse.
  Vec3 unproject(double x, double y, double depth, int width, int height) const;
  /// Where a point appears: pixels from the top left, and its distance along the line of sight. None behind the eye.
  std::optional<Vec3> project(const Vec3& point, int width, int height) const;
};

}  // namespace impinge
