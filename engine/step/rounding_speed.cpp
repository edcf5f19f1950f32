#include "engine/step/rounding_speed.hpp"

#include <algorithm>
#include <limits>

#include "engine/response/group_judge.hpp"

namespace impinge {
namespace {

// of the coordinates: a point is a sum of products, a gap or drift the difference of two, and two rows may differ by both
constexpr double kRoundings = 16.0;

/// The largest coordinate that a point of the side has, or its body.
double reach(const Bodies& bodies, const AssembledGroup& group, const ContactSide& side) {
  if (side.rigid >= 0)
    return bodies[group.rigid[side.rigid]].pose.position.cwiseAbs().maxCoeff() + side.arm.cwiseAbs().maxCoeff();
  if (side.deformable < 0) return 0.0;  // where it is the other side says
  const Aabb bounds = bodies[group.deformable[side.deformable]].bounds();
  return std::max(bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff());
}

}  // namespace

double rounding_speed(const Bodies& bodies, const AssembledGroup& group, double time_step) {
  double farthest = 0.0;
  for (const ContactRows& row : group.system.contacts)
    for (const ContactSide* side : {&row.a, &row.b}) farthest = std::max(farthest, reach(bodies, group, *side));
  const double of_positions = kRoundings * std::numeric_limits<double>::epsilon() * farthest / time_step;
  return std::max(of_positions, rounding_of_speeds(group.system));
}

}  // namespace impinge
