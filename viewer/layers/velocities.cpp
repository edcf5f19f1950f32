// Where the moving bodies' centres of mass would be some frames later, and the axes about which they turn.
#include "viewer/layers/all.hpp"

namespace impinge {
namespace {

constexpr double kFrames = 6.0;

void draw(const LayerContext& context, DrawList& list) {
  const double time = kFrames * context.record.frame_time;
  const float width = 1.7f * static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.kind == BodyKind::fixed) continue;
    const Vec3 way = body.velocity * time;
    if (way.squaredNorm() > 0.0)
      list.arrows.push_back({body.pose.position, way, role::kVelocity, 0.0f, width, Depth::on_top, body_pick(i)});
    const double angle = body.angular_velocity.norm() * time;
    if (angle > 0.02)  // one radian is as long as a normal
      list.arrows.push_back({body.pose.position, body.angular_velocity.normalized(), role::kSpin,
                             static_cast<float>(context.settings.arrow_length * std::min(angle, 4.0)), 0.8f * width,
                             Depth::on_top, body_pick(i)});
  }
}

}  // namespace

Layer velocities_layer() {
  return {
      "velocities",
      "Velocity (the way of the next six frames) and axis of rotation (a normal's length: one radian in six frames).",
      false,
      draw,
      {{LegendRow::arrow, role::kVelocity, "velocity, 6 frames"}, {LegendRow::arrow, role::kSpin, "axis of rotation"}}};
}

}  // namespace impinge
