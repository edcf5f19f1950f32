#include <imgui.h>
#include <algorithm>

#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {

void draw_labels(const Pen& pen, const std::vector<DrawLabel>& labels, const Camera& camera,
                 std::vector<PanelArea> taken) {
  struct Placed {
    Vec3 at;  // pixels and depth
    const DrawLabel* label;
  };
  std::vector<Placed> order;
  for (const DrawLabel& label : labels)
    if (const auto at =
            camera.project(label.position, static_cast<int>(pen.picture_width), static_cast<int>(pen.picture_height)))
      order.push_back({*at, &label});
  // nearer ones first: where two would meet, the farther one is left out
  std::stable_sort(order.begin(), order.end(), [](const Placed& l, const Placed& r) { return l.at.z() < r.at.z(); });
  const float pad = 3.0f * pen.unit;
  for (const Placed& placed : order) {
    PanelArea area;
    area.width = pen.text_width(placed.label->text) + 2.0f * pad;
    area.height = pen.text_size + 2.0f * pad;
    area.x = std::floor(static_cast<float>(placed.at.x()) - 0.5f * area.width);
    area.y = std::floor(static_cast<float>(placed.at.y()) - area.height - 3.0f * pen.unit);
    const bool inside = area.x >= 0.0f && area.y >= 0.0f && area.x + area.width <= pen.picture_width &&
                        area.y + area.height <= pen.picture_height;
    const bool meets =
        std::any_of(taken.begin(), taken.end(), [&](const PanelArea& t) { return panels_meet(t, area); });
    if (!inside || meets) continue;
    pen.list.AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height}, IM_COL32(18, 21, 26, 165),
                           3.0f * pen.unit);
    pen.text(area.x + pad, area.y + pad, placed.label->color, placed.label->text);
    taken.push_back(area);
  }
}

}  // namespace impinge
