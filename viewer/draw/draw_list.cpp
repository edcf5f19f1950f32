#include "viewer/draw/draw_list.hpp"

namespace impinge {

void DrawList::clear() {
  points.clear();
  lines.clear();
  arrows.clear();
  surfaces.clear();
  triangles.clear();
  planes.clear();
  labels.clear();
  color_bar.reset();
  layers.clear();
}

void DrawList::end_layer(std::string_view name) {
  layers.push_back(
      {name, points.size(), lines.size(), arrows.size(), surfaces.size(), triangles.size(), planes.size()});
}

void DrawList::add_box(const Pose& pose, const Vec3& low, const Vec3& high, Color color, float width, Depth depth,
                       PickId pick) {
  const auto corner = [&](int bits) {
    return pose.apply({bits & 1 ? high.x() : low.x(), bits & 2 ? high.y() : low.y(), bits & 4 ? high.z() : low.z()});
  };
  for (int from = 0; from < 8; ++from)
    for (int axis = 1; axis < 8; axis *= 2)
      if (!(from & axis)) lines.push_back({corner(from), corner(from | axis), color, width, depth, pick});
}

}  // namespace impinge
