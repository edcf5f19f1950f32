#include "engine/step/late_impacts.hpp"

#include <algorithm>

namespace impinge {
namespace {

/// Of row n, for bodies that are displaced so.
double along_normal(const ContactRows& row, const LateImpacts& by) {
  const auto of = [&](const ContactSide& side) {
    return side.rigid < 0 ? Vec3(Vec3::Zero())
                          : Vec3(by.linear[static_cast<std::size_t>(side.rigid)] +
                                 by.angular[static_cast<std::size_t>(side.rigid)].cross(side.arm));
  };
  return row.directions.row(0).dot(of(row.a) - of(row.b));
}

}  // namespace

std::optional<LateImpacts> late_impacts(const GroupSystem& solved, double time_step) {
  const auto is_late = [](const ContactRows& row) { return row.impact > 0.0; };
  if (!solved.deformable.empty() || std::none_of(solved.contacts.begin(), solved.contacts.end(), is_late))
    return std::nullopt;
  LateImpacts by;
  by.linear.assign(solved.rigid.size(), Vec3::Zero());
  by.angular = by.linear;
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& row = solved.contacts[i];
    if (!is_late(row)) continue;
    const Vec3 impulse = row.directions.transpose() * solved.lambda[i];
    for (const auto& [side, sign] : {std::pair(&row.a, -1.0), std::pair(&row.b, 1.0)}) {
      if (side->rigid < 0) continue;
      const auto b = static_cast<std::size_t>(side->rigid);
      const Vec3 late = sign * row.impact * impulse;
      by.linear[b] += solved.rigid[b].inverse_mass * late;
      by.angular[b] += solved.rigid[b].inverse_inertia * side->arm.cross(late);
    }
  }
  double share = 1.0;
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& row = solved.contacts[i];
    if (row.kind != RowKind::contact) continue;
    const double end = row.gap + row.turning + time_step * solved.displacement_velocity(i).x(),
                 more = along_normal(row, by);
    if (more < 0.0 && end + more < 0.0) share = std::min(share, std::max(end, 0.0) / -more);
  }
  for (Vec3& v : by.linear) v *= share;
  for (Vec3& v : by.angular) v *= share;
  return by;
}

}  // namespace impinge
