// The axes about which moving bodies turn, as long as they turn fast.
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

struct Settings {
  double length = 20.0;  // px

  void declare(const Rows& rows) {
    rows.add("length", length, {1.0, 1000.0}, "px", "Of one rad/s, in pixels of a picture 720 high.");
  }
};

void draw(const LayerContext& context, DrawList& list) {
  const double length = context.own<Settings>().length;
  const float width = 2.5f * static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    const double speed = body.angular_velocity.norm();
    if (body.kind == BodyKind::fixed || body.deformable != nullptr || speed == 0.0) continue;
    list.arrows.push_back({body.pose.position, body.angular_velocity / speed, role::kOverlap,
                           static_cast<float>(length * speed), width, Depth::on_top, body_pick(i)});
  }
}

}  // namespace

Layer spin_axes_layer() {
  return {"spin_axes",
          "Angular velocities.",
          false,
          draw,
          {{LegendRow::arrow, role::kOverlap, "angular velocity", has_rigid}},
          Settings{}};
}

}  // namespace impinge
