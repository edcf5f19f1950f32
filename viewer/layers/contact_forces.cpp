// The force of every contact, impulse over time step: on body A, or on body B where A cannot be moved. As long as a
// normal is a round number of newtons, which the legend tells.
#include <algorithm>
#include <cmath>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/quantity_arrow.hpp"

namespace impinge {
namespace {

/// What a contact carries of a resting body, N: the mean weight, shared by the contacts that carry a body; a mesh may
/// rest on hundreds. 0: nothing is known of it.
double share_of_weight(const StepRecord& record) {
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

/// The force in the middle of those that are there, N: what is pressed together carries more than weights. 0: none.
double middle_force(const StepRecord& record, double step) {
  std::vector<double> sizes;
  for (const ContactRecord& c : record.contacts)
    if (const double size = c.lambda.norm() / step; size > 0.0 && std::isfinite(size)) sizes.push_back(size);
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

struct ForceSettings {
  double unit = 0.0;  // N

  void declare(const Rows& rows) {
    rows.add("unit", unit, {0.0, 1e15, true}, "N",
             "The contact force that is drawn view.arrow_length long. 0 chooses in each frame: 1, 2 or 5 times a power "
             "of ten, not below the middle one of its forces, nor what a contact carries of a body's weight.")
        .formerly("view.force_unit");
  }
};

void draw_contact_forces(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const double step = record.frame_time / std::max(1, record.stats.substeps);
  if (!(step > 0.0)) return;
  double unit = context.own<ForceSettings>().unit;
  if (const double middle = middle_force(record, step); unit == 0.0 && middle > 0.0)
    unit = rounded_up(std::max(middle, share_of_weight(record)));
  if (!(unit > 0.0)) return;
  const std::size_t before = list.arrows.size();
  for (std::size_t i = 0; i < record.contacts.size(); ++i) {
    const ContactRecord& c = record.contacts[i];
    const bool on_b = !is_moved_by_contact(record.bodies[c.body_a]);
    const Vec3 t1 = tangent1(c.normal), t2 = c.normal.cross(t1);
    const Vec3 force = (c.lambda[0] * c.normal + c.lambda[1] * t1 + c.lambda[2] * t2) * ((on_b ? -1.0 : 1.0) / step);
    const double size = force.norm();
    add_quantity_arrow(context.settings,
                       {on_b ? c.point_b : c.point_a, force / size, role::kForce, 0.0f,
                        2.0f * static_cast<float>(context.settings.line_width), Depth::on_top, contact_pick(i)},
                       size / unit, list);
  }
  if (list.arrows.size() > before) add_arrow_scale(context, role::kForce, unit, "N", list);
}

}  // namespace

Layer contact_forces_layer() {
  return {"contact_forces",
          "Contact forces with friction; the legend says how many newtons an arrow of its length stands for.",
          false,
          draw_contact_forces,
          {{LegendRow::arrow, role::kForce, "contact force of {} (on A, if it can move)"}},
          ForceSettings{}};
}

}  // namespace impinge
