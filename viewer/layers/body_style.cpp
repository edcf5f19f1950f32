#include "viewer/layers/body_style.hpp"

#include <algorithm>

namespace impinge {
namespace {

/// The axis of a box across which it is thin, or -1.
int thin_axis(const BodyRecord& body) {
  const auto* box = std::get_if<Box>(body.shape);
  if (box == nullptr || body.kind != BodyKind::fixed) return -1;
  int axis = 0;
  const double thinnest = box->half.minCoeff(&axis);
  const double next = std::min(box->half[(axis + 1) % 3], box->half[(axis + 2) % 3]);
  return thinnest < 0.3 * next ? axis : -1;
}

}  // namespace

std::vector<Color> body_colors(const StepRecord& record) {
  std::vector<Color> colors;
  int turn = 0;
  for (const BodyRecord& body : record.bodies) {
    switch (body.kind) {
      case BodyKind::fixed:
        colors.push_back(role::kStatic);
        break;
      case BodyKind::scripted:
        colors.push_back(role::kScripted);
        break;
      default:
        colors.push_back(series_color(turn++));
        break;
    }
  }
  return colors;
}

bool is_wall(const BodyRecord& body) { return thin_axis(body) >= 0; }

bool is_wall_in_the_way(const BodyRecord& body, const Camera& camera) {
  const int axis = thin_axis(body);
  if (axis < 0) return false;
  const double half = std::get<Box>(*body.shape).half[axis];
  const double eye = body.pose.apply_inverse(camera.eye)[axis], target = body.pose.apply_inverse(camera.target)[axis];
  return (eye > half && target < half) || (eye < -half && target > -half);
}

}  // namespace impinge
