// Bars on hinges and on single points.
#pragma once

#include <algorithm>
#include <string>

#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

enum class HingeKind { points, swapped, point_and_line };

/// Two bodies, or one and the world, at two points at `half` to each side.
inline void add_hinge(World& world, HingeKind kind, const std::string& a, const std::string& b, const Vec3& at,
                      double half) {
  for (const double side : {1.0, -1.0}) {
    AttachmentDescription pin{a + (side > 0.0 ? " front" : " back"), a, b, at + side * half * Vec3::UnitZ()};
    pin.collide = false;
    if (side < 0.0 && kind == HingeKind::swapped && !b.empty()) std::swap(pin.body_a, pin.body_b);
    if (side < 0.0 && kind == HingeKind::point_and_line) pin.kind = AttachmentKind::line, pin.axis = Vec3::UnitZ();
    world.add_attachment(pin);
  }
}

/// Bars of 0.3 m and 1 kg from the origin along x, the last of `ratio` kg, on hinges or on single points. Returns what the fall
/// of all to straight down gives, J.
inline double add_bars(World& world, int links, double ratio, bool is_rope, HingeKind kind = HingeKind::points) {
  double fall = 0.0;
  for (int i = 0; i < links; ++i) {
    BodyDescription bar =
        dynamic_body("bar" + std::to_string(i), Box{Vec3(0.135, 0.02, 0.05)}, Vec3(0.3 * (i + 0.5), 0, 0));
    bar.mass = i == links - 1 ? ratio : 1.0;
    fall += *bar.mass * kGravity * 0.3 * (i + 0.5);
    world.add_body(bar);
  }
  for (int i = 0; i < links; ++i)
    add_hinge(world, kind, "bar" + std::to_string(i), i > 0 ? "bar" + std::to_string(i - 1) : "", Vec3(0.3 * i, 0, 0),
              is_rope ? 0.0 : 0.02);
  return fall;
}

inline void settle_method(World& world, const std::string& method, int substeps) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = substeps;
  world.parameters.response.method = method;
}

inline double widest(const World& world) {
  double apart = 0.0;
  for (const AttachmentRecord& pin : world.record().attachments)
    apart = std::max(apart, (pin.point_a - pin.point_b).norm());
  return apart;
}

}  // namespace impinge::test
