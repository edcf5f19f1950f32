// Attachments: the two points that are held together, and the line between them where they are apart.
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) {
  const float size = 0.9f * static_cast<float>(context.settings.point_size),
              width = 1.8f * static_cast<float>(context.settings.line_width);
  for (const AttachmentRecord& link : context.record.attachments) {
    const PickId pick = body_pick(static_cast<std::size_t>(std::max(0, link.body_a.value())));
    list.lines.push_back({link.point_a, link.point_b, role::kAttachment, width, Depth::both, pick});
    for (const Vec3& p : {link.point_a, link.point_b}) {
      list.points.push_back({p, role::kAttachment, size, Depth::both, pick});
      list.points.push_back({p, role::kOutline, 0.4f * size, Depth::both, pick});
    }
  }
}

}  // namespace

Layer attachments_layer() {
  return {"attachments",
          "Attached points, with a line between the two where they are apart.",
          false,
          draw,
          {{LegendRow::ring, role::kAttachment, "attachment", has_attachments}}};
}

}  // namespace impinge
