// The force of every contact, impulse over time step: on body A, or on body B where A cannot be moved. As long as a
// normal is the mean weight of the bodies that contact moves, shared by the mean number of contacts that carry one;
// without gravity the frame's largest force is.
#include <algorithm>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kLongest = 5.0;  // times the length of a normal: an impact must not cross the picture

/// The force that is as long as a normal, N; 0: nothing is known of it. A body's weight, shared by the contacts that
/// carry it: a mesh may rest on hundreds.
double force_unit(const StepRecord& record) {
  double mass = 0.0;
  int count = 0;
  for (const BodyRecord& body : record.bodies)
    if (is_moved_by_contact(body)) mass += body.mass, ++count;
  if (count == 0) return 0.0;
  std::vector<bool> carried(record.bodies.size(), false);
  int contacts = 0;
  for (const ContactRecord& c : record.contacts) {
    if (!(c.lambda[0] > 0.0)) continue;
    ++contacts;
    for (const int b : {c.body_a, c.body_b})
      if (is_moved_by_contact(record.bodies[b])) carried[b] = true;
  }
  const double bodies = std::max<double>(1.0, static_cast<double>(std::count(carried.begin(), carried.end(), true)));
  return mass / count * record.gravity.norm() / std::max(1.0, contacts / bodies);
}

struct ForceSettings {
  double unit = 0.0;  // N

  void declare(const Rows& rows) {
    rows.add("unit", unit, {0.0, 1e15, true}, "N",
             "The contact force that is drawn view.arrow_length long; 0 chooses by the bodies' weights.")
        .formerly("view.force_unit");
  }
};

void draw_contact_forces(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const double step = record.frame_time / std::max(1, record.stats.substeps);
  if (!(step > 0.0)) return;
  const double given = context.own<ForceSettings>().unit;
  double unit = given > 0.0 ? given : force_unit(record);
  if (unit <= 0.0)
    for (const ContactRecord& c : record.contacts) unit = std::max(unit, c.lambda.norm() / step);
  if (unit <= 0.0) return;
  for (std::size_t i = 0; i < record.contacts.size(); ++i) {
    const ContactRecord& c = record.contacts[i];
    const bool on_b = !is_moved_by_contact(record.bodies[c.body_a]);
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
          "Contact forces with friction; a normal's length is the bodies' mean weight over the mean number of contacts "
          "that carry one.",
          false,
          draw_contact_forces,
          {{LegendRow::arrow, role::kForce, "contact force (on A, if it can move)"}},
          ForceSettings{}};
}

}  // namespace impinge
