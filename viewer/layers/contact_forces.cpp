// The force of every contact, impulse over time step: on body A, or on body B where A cannot be moved. The mean weight
// of the dynamic bodies is as long as a normal; without gravity the frame's largest force is.
#include <algorithm>

#include "viewer/layers/all.hpp"

namespace impinge {
namespace {

constexpr double kLongest = 5.0;  // times the length of a normal: an impact must not cross the picture

double mean_weight(const StepRecord& record) {
  double mass = 0.0;
  int count = 0;
  for (const BodyRecord& body : record.bodies)
    if (body.kind == BodyKind::dynamic) mass += body.mass, ++count;
  return count > 0 ? mass / count * record.gravity.norm() : 0.0;
}

void draw(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const double step = record.frame_time / std::max(1, record.stats.substeps);
  if (!(step > 0.0)) return;
  double unit = mean_weight(record);
  if (unit <= 0.0)
    for (const ContactRecord& c : record.contacts) unit = std::max(unit, c.lambda.norm() / step);
  if (unit <= 0.0) return;
  for (std::size_t i = 0; i < record.contacts.size(); ++i) {
    const ContactRecord& c = record.contacts[i];
    const bool on_b = record.bodies[c.body_a].kind != BodyKind::dynamic;
    const Vec3 t1 = tangent1(c.normal), t2 = c.normal.cross(t1);
    const Vec3 force = (c.lambda[0] * c.normal + c.lambda[1] * t1 + c.lambda[2] * t2) * ((on_b ? -1.0 : 1.0) / step);
    const double size = force.norm();
    const double length = context.settings.arrow_length * std::min(size / unit, kLongest);
    if (length < 0.5) continue;  // half a pixel
    list.arrows.push_back({on_b ? c.point_b : c.point_a, force / size, role::kForce, static_cast<float>(length),
                           2.0f * static_cast<float>(context.settings.line_width), Depth::on_top, contact_pick(i)});
  }
}

}  // namespace

Layer contact_forces_layer() {
  return {"contact_forces",
          "Contact forces with friction; a normal's length is the bodies' mean weight.",
          false,
          draw,
          {{LegendRow::arrow, role::kForce, "contact force on A (on B if A is fixed)"}}};
}

}  // namespace impinge
