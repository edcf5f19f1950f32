#include "viewer/layers/body_style.hpp"

#include <algorithm>

#include "engine/shapes/primitives.hpp"
#include "viewer/draw/body_color.hpp"

namespace impinge {
namespace {

/// The axis of a box across which it is thin, or -1.
int thin_axis(const BodyRecord& body) {
  const auto* box = body.shape->as<Box>();
  if (box == nullptr || body.kind != BodyKind::fixed) return -1;
  int axis = 0;
  const double thinnest = box->half.minCoeff(&axis);
  const double next = std::min(box->half[(axis + 1) % 3], box->half[(axis + 2) % 3]);
  return thinnest < 0.3 * next ? axis : -1;
}

template <class Condition>
bool any_body(const StepRecord& record, Condition&& condition) {
  return std::any_of(record.bodies.begin(), record.bodies.end(), condition);
}

}  // namespace

std::vector<Color> body_colors(const StepRecord& record, const std::vector<std::string>& given) {
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
    if (const std::optional<Color> own = given_color(given, body.name)) colors.back() = *own;
  }
  return colors;
}

bool has_rigid(const StepRecord& record) {
  return any_body(record,
                  [](const BodyRecord& b) { return b.kind == BodyKind::dynamic || b.kind == BodyKind::scripted; });
}
bool has_deformable(const StepRecord& record) {
  return any_body(record, [](const BodyRecord& b) { return b.deformable != nullptr; });
}
bool has_held_nodes(const StepRecord& record) {
  return any_body(record, [](const BodyRecord& b) {
    return b.deformable != nullptr && b.deformable->free_nodes() < b.deformable->nodes();
  });
}
bool has_outside_vertices(const StepRecord& record) {
  return any_body(record,
                  [](const BodyRecord& b) { return b.deformable != nullptr && b.deformable->embedding.outside > 0; });
}
bool has_everted(const StepRecord& record) {
  return any_body(record, [](const BodyRecord& b) {
    return b.deformable != nullptr && b.deformable->smallest_volume_ratio() <= 0.0;
  });
}
bool has_attachments(const StepRecord& record) { return !record.attachments.empty(); }

bool is_moved_by_contact(const BodyRecord& body) {
  return body.kind == BodyKind::dynamic || body.kind == BodyKind::deformable;
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t stride = most == 0 ? 1 : std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = 0; i < count; i += stride) out.push_back(i);
  return out;
}

bool is_wall(const BodyRecord& body) { return thin_axis(body) >= 0; }

bool is_wall_in_the_way(const BodyRecord& body, const Camera& camera) {
  const int axis = thin_axis(body);
  if (axis < 0) return false;
  const double half = body.shape->as<Box>()->half[axis];
  const double eye = body.pose.apply_inverse(camera.eye)[axis], target = body.pose.apply_inverse(camera.target)[axis];
  return (eye > half && target < half) || (eye < -half && target > -half);
}

}  // namespace impinge
