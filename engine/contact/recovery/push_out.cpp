#include "engine/contact/recovery/push_out.hpp"

#include <algorithm>

namespace impinge {
namespace {

/// Overlap below this is rounding, not overlap: pushing it out would cost a solve a sub-step for nothing.
double slop(const ContactRows& rows, const ContactSettings& settings) {
  return 1e-6 * settings.activation_distance.at(rows.scale.length);
}

}  // namespace

bool needs_push_out(const GroupSystem& solved, std::span<const Vec3> drift, const ContactSettings& settings,
                    double time_step) {
  if (settings.push_out != PushOut::split) return false;
  // rows whose positions move by Δt v leave no overlap that wasn't there; others (Newmark) are asked
  const bool all_move = std::all_of(solved.deformable.begin(), solved.deformable.end(),
                                    [](const DeformableBlock& b) { return b.displacement_scale == 1.0; });
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& c = solved.contacts[i];
    if (!drift.empty() && drift[i].norm() > slop(c, settings)) return true;
    if (c.kind != RowKind::contact) continue;
    const double gap = all_move ? c.gap : std::min(c.gap, c.gap + time_step * solved.displacement_velocity(i).x());
    if (gap < -slop(c, settings) && settings.max_push_out.at(c.scale.speed) > 0.0) return true;
  }
  return false;
}

GroupSystem make_push_out_system(const GroupSystem& solved, std::span<const Vec3> drift,
                                 const ContactSettings& settings, double time_step) {
  GroupSystem push = solved;
  for (RigidBlock& body : push.rigid) body.velocity.setZero(), body.angular_velocity.setZero();
  for (DeformableBlock& block : push.deformable) block.velocity.setZero();
  for (std::size_t i = 0; i < push.contacts.size(); ++i) {
    ContactRows& rows = push.contacts[i];
    push.lambda[i].setZero();
    if (rows.kind != RowKind::contact) {
      rows.surface.setZero();
      if (!drift.empty()) rows.surface = rows.directions * drift[i] / time_step;
      continue;
    }
    const double gap_after = rows.gap + rows.turning + time_step * solved.displacement_velocity(i).x();
    rows.surface.setZero();
    rows.friction = rows.restitution = 0.0;
    // an overlap is measured after the velocities have moved the bodies: separation that they bring is not added twice
    const double most = settings.max_push_out.at(rows.scale.speed);
    rows.bound = gap_after >= 0.0 ? -gap_after / time_step : std::min(-gap_after / time_step, most);
  }
  return push;
}

}  // namespace impinge
