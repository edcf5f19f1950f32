// Where the moving bodies' centres of mass (points of deformable surfaces) would be some frames later, and the axes
// about which they turn.
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/quantity_arrow.hpp"

namespace impinge {
namespace {

constexpr double kFrames = 6.0;
constexpr double kLeastWay = 0.5;  // pixels: the head of an arrow has a least size, which a body at rest must not have
constexpr int kPictureHeight = 720;         // that view.arrow_length and others mean
constexpr std::size_t kMostVertices = 160;  // of a deformable body

/// At some of the surface's vertices: what the nodes that carry them have.
void draw_deformable(const LayerContext& context, DrawList& list, std::size_t index, double time, float width) {
  const BodyRecord& body = context.record.bodies[index];
  const Embedding& embedding = body.deformable->embedding;
  const double shortest = 0.012 * body.bounds.extent().norm();
  for (const std::size_t v : thinned(body.vertices.size(), kMostVertices)) {
    Vec3 way = Vec3::Zero();
    const Tet& tet = body.deformable->fem.rest().tets[static_cast<std::size_t>(embedding.tet[v])];
    for (int k = 0; k < 4; ++k) way += time * embedding.weight[v][k] * body.deformable->velocity.segment<3>(3 * tet[k]);
    if (way.norm() > shortest)
      list.arrows.push_back({body.vertices[v], way, role::kVelocity, 0.0f, width, Depth::both, body_pick(index)});
  }
}

void draw_velocities(const LayerContext& context, DrawList& list) {
  const double time = kFrames * context.record.frame_time;
  const float width = 1.7f * static_cast<float>(context.settings.line_width);
  const std::size_t before = list.arrows.size();
  bool turns = false;
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.kind == BodyKind::fixed) continue;
    if (body.deformable != nullptr && !body.deformable->embedding.tet.empty()) {
      draw_deformable(context, list, i, time, 0.7f * width);
      continue;
    }
    const Vec3 way = body.velocity * time;
    if (way.norm() > kLeastWay * context.camera.pixel_size_at(body.pose.position, kPictureHeight))
      list.arrows.push_back({body.pose.position, way, role::kVelocity, 0.0f, width, Depth::on_top, body_pick(i)});
    const double angle = body.angular_velocity.norm() * time;
    if (!(angle > 0.02)) continue;
    add_quantity_arrow(context.settings,
                       {body.pose.position, body.angular_velocity.normalized(), role::kSpin, 0.0f, 0.8f * width,
                        Depth::on_top, body_pick(i)},
                       angle, list);  // one radian is as long as a normal
    turns = true;
  }
  if (list.arrows.size() > before) list.scales.push_back({context.layer, role::kVelocity, time, "s"});
  if (turns) add_arrow_scale(context, role::kSpin, 1.0 / time, "rad/s", list);
}

}  // namespace

Layer velocities_layer() {
  return {
      "velocities",
      "Velocity (the way of the next six frames) and axis of rotation (a normal's length: one radian in six frames).",
      false,
      draw_velocities,
      {{LegendRow::arrow, role::kVelocity, "velocity: way of {}"}, {LegendRow::arrow, role::kSpin, "rotation: {}"}}};
}

}  // namespace impinge
