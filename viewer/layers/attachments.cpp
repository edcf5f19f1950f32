// Attachments: the point of the one body and the place that holds it, the line between them where they are apart; and of
// those that slide, where they may go.
#include <algorithm>

#include "engine/contact/contact_frame.hpp"
#include "engine/shapes/primitives.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kWayOf = 1.0;  // of the diagonal of the body's box: how far the mark of its way goes, to either side
constexpr double kPatch = 0.4;  // of that: the patch of a surface, which holds near the point only
constexpr float kMarkAlpha = 0.8f;

bool has_slides(const StepRecord& record) {
  return std::any_of(record.attachments.begin(), record.attachments.end(),
                     [](const AttachmentRecord& a) { return a.kind != AttachmentKind::point; });
}

/// How far the mark of its way reaches: by the size of the body that slides.
double half_way(const AttachmentRecord& link, const StepRecord& record) {
  for (const BodyIndex b : {link.body_a, link.body_b}) {
    if (b.is_none()) continue;
    const Aabb& box = record.bodies[static_cast<std::size_t>(b.value())].bounds;
    if (!box.is_empty() && box.extent().allFinite()) return kWayOf * box.extent().norm();
  }
  return kWayOf;
}

/// A square across `normal` with its middle lines.
void add_patch(const Vec3& at, const Vec3& normal, double half, const DrawLine& like, DrawList& list) {
  const Vec3 u = half * tangent1(normal), v = normal.cross(u);
  const auto add = [&](const Vec3& a, const Vec3& b, float width) {
    DrawLine line = like;
    line.a = at + a, line.b = at + b, line.width = width;
    list.lines.push_back(line);
  };
  const std::array<Vec3, 4> corners = {u + v, v - u, -u - v, u - v};
  for (std::size_t k = 0; k < 4; ++k) add(corners[k], corners[(k + 1) % 4], like.width);
  for (const Vec3& middle : {u, v}) add(-middle, middle, 0.5f * like.width);
}

void draw_way(const AttachmentRecord& link, double reach, const DrawLine& like, DrawList& list) {
  if (link.kind == AttachmentKind::line) {
    for (const double sign : {-1.0, 1.0})
      list.arrows.push_back(
          {link.point_b, sign * reach * link.axis, like.color, 0.0f, like.width, Depth::both, like.pick});
    return;
  }
  const bool is_plane = link.kind == AttachmentKind::plane;
  add_patch(link.point_b, link.axis, is_plane ? reach : kPatch * reach, like, list);
  if (is_plane) return;
  DrawLine normal = like;
  normal.a = link.point_b, normal.b = link.point_b + kPatch * reach * link.axis;
  list.lines.push_back(normal);
}

/// Thin lines from the point to the middles of the bodies that it holds together.
void draw_spokes(const AttachmentRecord& link, const StepRecord& record, const DrawLine& like, DrawList& list) {
  for (const auto& [b, point] : {std::pair(link.body_a, link.point_a), {link.body_b, link.point_b}}) {
    if (b.is_none()) continue;
    const BodyRecord& body = record.bodies[static_cast<std::size_t>(b.value())];
    if (body.deleted || body.shape->as<Plane>() != nullptr) continue;
    DrawLine spoke = like;
    spoke.a = point, spoke.b = body.pose.position;
    list.lines.push_back(spoke);
  }
}

void draw_attachments(const LayerContext& context, DrawList& list) {
  const float size = 0.9f * static_cast<float>(context.settings.point_size),
              width = 1.8f * static_cast<float>(context.settings.line_width);
  for (const AttachmentRecord& link : context.record.attachments) {
    const PickId pick = body_pick(static_cast<std::size_t>(std::max(0, link.body_a.value())));
    if (link.kind != AttachmentKind::point) {
      const DrawLine mark{{}, {}, with_alpha(role::kAttachment, kMarkAlpha), 0.7f * width, Depth::both, pick};
      draw_way(link, half_way(link, context.record), mark, list);
    } else {
      draw_spokes(link, context.record,
                  {{}, {}, with_alpha(role::kAttachment, kMarkAlpha), 0.5f * width, Depth::both, pick}, list);
    }
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
          "Attached points, with thin lines to the middles of the bodies they hold and a line between the two points "
          "where they are apart; and the line, plane or surface that a point slides on.",
          false,
          draw_attachments,
          {{LegendRow::ring, role::kAttachment, "attachment", has_attachments},
           {LegendRow::line, role::kAttachment, "where it slides", has_slides}}};
}

}  // namespace impinge
