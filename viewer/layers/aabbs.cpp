// The axis-aligned boxes that the broad phase compares, of every body that can move.
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_aabbs(const LayerContext& context, DrawList& list) {
  const Color color = context.settings.backdrop == BackdropStyle::light
                          ? with_alpha(mix(role::kAabb, role::kOutline, 0.55f), 0.8f)
                          : with_alpha(role::kAabb, 0.75f);
  const float width = static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.kind == BodyKind::fixed || body.bounds.is_empty()) continue;
    list.add_box(Pose{}, body.bounds.min, body.bounds.max, color, 0.8f * width, Depth::both, body_pick(i));
  }
}

}  // namespace

Layer aabbs_layer() {
  return {"aabbs",
          "Axis-aligned bounding boxes of dynamic and scripted bodies.",
          false,
          draw_aabbs,
          {{LegendRow::line, role::kAabb, "bounding box"}}};
}

}  // namespace impinge
