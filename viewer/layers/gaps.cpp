// The two points of every contact and the line between them, whose length along the normal is the gap.
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_gaps(const LayerContext& context, DrawList& list) {
  const float width = static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.contacts.size(); ++i) {
    const ContactRecord& c = context.record.contacts[i];
    const Color color = c.gap < 0.0 ? role::kOverlap : role::kGap;
    list.lines.push_back({c.point_a, c.point_b, color, 1.6f * width, Depth::on_top, contact_pick(i)});
    for (const Vec3& p : {c.point_a, c.point_b})
      list.points.push_back({p, color, 2.2f * width, Depth::on_top, contact_pick(i)});
  }
}

}  // namespace

Layer gaps_layer() {
  return {"gaps",
          "From point A to point B of every contact.",
          false,
          draw_gaps,
          {{LegendRow::line, role::kGap, "gap, apart"}, {LegendRow::line, role::kOverlap, "gap, overlapping"}}};
}

}  // namespace impinge
