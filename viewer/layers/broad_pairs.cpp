// The pairs that the broad phase let through: from box middle to box middle, to a plane along its normal.
#include "engine/shapes/primitives.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/layers/view_bodies.hpp"

namespace impinge {
namespace {

Vec3 end_of(const BodyRecord& body, const BodyRecord& other) {
  const auto* plane = body.shape->as<Plane>();
  if (plane == nullptr) return body.bounds.center();
  const Vec3 n = body.pose.rotation * plane->normal, from = other.bounds.center();
  return from - n * (n.dot(from - body.pose.position) - plane->offset);
}

void draw_broad_pairs(const LayerContext& context, DrawList& list) {
  const std::vector<BodyRecord>& bodies = context.record.bodies;
  const float width = 1.2f * static_cast<float>(context.settings.line_width);
  const BodySet hidden = not_drawn(context.record, context.settings);
  for (const BodyPair& pair : context.record.broad_pairs) {
    if (pair.a == pair.b || hidden.has(pair.a) || hidden.has(pair.b)) continue;
    const Vec3 a = end_of(bodies[pair.a], bodies[pair.b]), b = end_of(bodies[pair.b], bodies[pair.a]);
    list.lines.push_back({a, b, role::kPair, width, Depth::on_top, 0});
    for (const Vec3& p : {a, b}) list.points.push_back({p, role::kPair, 3.0f * width, Depth::on_top, 0});
  }
}

}  // namespace

Layer broad_pairs_layer() {
  return {"broad_pairs",
          "Body pairs that the broad phase hands on.",
          false,
          draw_broad_pairs,
          {{LegendRow::line, role::kPair, "broad-phase pair"}}};
}

}  // namespace impinge
