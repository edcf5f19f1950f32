// Colours the surfaces by collision group instead of by body. A group has the colour of its first body, so that it
// keeps its colour while it lasts.
#include <algorithm>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_groups(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const std::vector<Color> colors = body_colors(record, context.settings.colors);
  for (DrawSurface& item : list.surfaces) {
    if (item.pick == 0 || item.pick > record.bodies.size()) continue;
    const BodyRecord& body = record.bodies[item.pick - 1];
    if (!is_moved_by_contact(body)) continue;
    item.color = role::kUngrouped;
    if (body.group >= 0)
      for (const int member : record.groups[body.group])
        if (is_moved_by_contact(record.bodies[member])) {
          item.color = colors[member];
          break;
        }
    if (item.asleep) item.color = asleep_color(item.color);
  }
}

bool has_ungrouped(const StepRecord& record) {
  return std::any_of(record.bodies.begin(), record.bodies.end(), [](const BodyRecord& body) {
    return is_moved_by_contact(body) && !body.deleted && body.group.is_none();
  });
}

}  // namespace

Layer groups_layer() {
  return {"groups",
          "Surfaces coloured by collision group.",
          false,
          draw_groups,
          {{LegendRow::area, role::kUngrouped, "in no collision group", has_ungrouped}}};
}

}  // namespace impinge
