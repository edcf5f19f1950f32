#include "viewer/draw/draw_list.hpp"

#include <algorithm>

namespace impinge {

void DrawList::clear() {
  points.clear();
  lines.clear();
  arrows.clear();
  surfaces.clear();
  triangles.clear();
  planes.clear();
  labels.clear();
  color_bars.clear();
  scales.clear();
  layers.clear();
}

void DrawList::end_layer(std::string_view name) {
  layers.push_back(
      {name, points.size(), lines.size(), arrows.size(), surfaces.size(), triangles.size(), planes.size()});
}

bool DrawList::has_color(std::string_view layer, Color color) const {
  DrawnLayer before;
  for (const DrawnLayer& drawn : layers) {
    const auto has = [&](const auto& items, std::size_t DrawnLayer::*count) {
      const auto begin = items.begin() + static_cast<std::ptrdiff_t>(before.*count),
                 end = items.begin() + static_cast<std::ptrdiff_t>(drawn.*count);
      return std::any_of(begin, end, [&](const auto& item) {
        if constexpr (requires { item.heat; })
          if (item.heat != nullptr) return false;  // of the bar's colours
        return with_alpha(item.color, color.a) == color;
      });
    };
    if (drawn.name == layer &&
        (has(points, &DrawnLayer::points) || has(lines, &DrawnLayer::lines) || has(arrows, &DrawnLayer::arrows) ||
         has(surfaces, &DrawnLayer::surfaces) || has(triangles, &DrawnLayer::triangles)))
      return true;
    before = drawn;
  }
  return false;
}

bool DrawList::has_cut_arrow(std::string_view layer, Color color) const {
  std::size_t first = 0;
  for (const DrawnLayer& drawn : layers) {
    if (drawn.name == layer &&
        std::any_of(arrows.begin() + static_cast<std::ptrdiff_t>(first),
                    arrows.begin() + static_cast<std::ptrdiff_t>(drawn.arrows),
                    [&](const DrawArrow& arrow) { return arrow.is_cut && with_alpha(arrow.color, color.a) == color; }))
      return true;
    first = drawn.arrows;
  }
  return false;
}

void DrawList::leave_out(const std::function<bool(PickId)>& is_out) {
  // what stays of a kind, and how much of it each layer had before
  const auto thin = [&](auto& items, std::size_t DrawnLayer::*count) {
    std::size_t kept = 0, next = 0;
    auto layer = layers.begin();
    for (; next < items.size(); ++next) {
      for (; layer != layers.end() && (*layer).*count <= next; ++layer) (*layer).*count = kept;
      if (is_out(items[next].pick)) continue;
      if (kept != next) items[kept] = std::move(items[next]);
      ++kept;
    }
    for (; layer != layers.end(); ++layer) (*layer).*count = kept;
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(kept), items.end());
  };
  thin(points, &DrawnLayer::points);
  thin(lines, &DrawnLayer::lines);
  thin(arrows, &DrawnLayer::arrows);
  thin(surfaces, &DrawnLayer::surfaces);
  thin(triangles, &DrawnLayer::triangles);
  thin(planes, &DrawnLayer::planes);
  std::erase_if(labels, [&](const DrawLabel& label) { return is_out(label.pick); });
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
