#include "viewer/draw/box_in_picture.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace impinge {

BoxInPicture box_in_picture(const Aabb& box, const Camera& camera, int width, int height) {
  const Mat3 axes = camera.view_rotation();
  const double up = std::tan(0.5 * camera.fov_deg * std::numbers::pi / 180.0), across = up * width / height;
  Vec2 low = Vec2::Constant(INFINITY), high = Vec2::Constant(-INFINITY);
  int in_front = 0;
  int beyond[4] = {};  // corners on the far side of each plane through the eye and a border of the picture
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
    const Vec3 seen = axes * (x - camera.eye);
    const double depth = -seen.z();
    const bool is_beyond[4] = {seen.x() > across * depth, -seen.x() > across * depth, seen.y() > up * depth,
                               -seen.y() > up * depth};
    for (int side = 0; side < 4; ++side) beyond[side] += is_beyond[side] ? 1 : 0;
    const std::optional<Vec3> at = camera.project(x, width, height);
    if (!at) continue;
    ++in_front;
    low = low.cwiseMin(at->head<2>()), high = high.cwiseMax(at->head<2>());
  }
  const bool is_outside = std::any_of(std::begin(beyond), std::end(beyond), [](int corners) { return corners == 8; });
  if (in_front == 0) return {false, true, 0.0};
  return {!is_outside, false, in_front < 8 ? static_cast<double>(height) : (high - low).maxCoeff()};
}

}  // namespace impinge
