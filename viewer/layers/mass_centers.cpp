// Centres of mass and the axes of the bodies' frames: x red, y green, z blue. Targets, which no contact is, and bars
// without heads, which no force is: their colours alone are near those of open contacts and of forces.
#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_mass_centers(const LayerContext& context, DrawList& list) {
  const float length = 0.8f * static_cast<float>(context.settings.arrow_length),
              width = 1.5f * static_cast<float>(context.settings.line_width);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.kind == BodyKind::fixed) continue;
    const Color colors[3] = {role::kAxisX, role::kAxisY, role::kAxisZ};
    for (int axis = 0; axis < 3 && body.deformable == nullptr; ++axis)  // a deformable body has no frame
      list.arrows.push_back({body.pose.position, body.pose.rotation.col(axis), colors[axis], length, width,
                             Depth::on_top, body_pick(i), false});
    const float size = 1.4f * static_cast<float>(context.settings.point_size);
    for (const auto& [color, share] :
         {std::pair{role::kMassCenter, 1.0f}, {role::kOutline, 0.55f}, {role::kMassCenter, 0.28f}})
      list.points.push_back({body.pose.position, color, share * size, Depth::on_top, body_pick(i)});
  }
}

}  // namespace

Layer mass_centers_layer() {
  return {"mass_centers",
          "Centres of mass with the axes of the bodies' frames.",
          false,
          draw_mass_centers,
          {{LegendRow::target, role::kMassCenter, "centre of mass"},
           {LegendRow::bar, role::kAxisX, "body axis x"},
           {LegendRow::bar, role::kAxisY, "body axis y"},
           {LegendRow::bar, role::kAxisZ, "body axis z"}}};
}

}  // namespace impinge
