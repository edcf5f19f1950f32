#include "engine/detection/continuous/moving_solid.hpp"

#include <algorithm>

#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/geometry/rotation.hpp"

namespace impinge {

Vec3 MovingSolid::turn() const { return rotation_log(last.rotation * first.rotation.transpose()); }

double MovingSolid::swing_beside(const MovingSolid& b) const {
  if (radius == 0.0) return 0.0;
  const Vec3 relative = turn() - b.turn();
  const double angle = relative.norm();
  return is_round ? std::min(angle, relative.cross(first.rotation.col(1)).norm() + angle * angle) : angle;
}

double bend_between(const MovingSolid& a, const MovingSolid& b) {
  const Vec3 turn_a = a.turn(), turn_b = b.turn();
  const double from_b =
      std::max((a.first.position - b.first.position).norm(), (a.last.position - b.last.position).norm());
  const double own = turn_b.norm(), relative = a.radius == 0.0 ? 0.0 : (turn_a - turn_b).norm();
  const double of_centre = own * own * from_b + 2.0 * own * (a.way() - b.way()).norm();
  double of_turn = relative * relative + own * relative;
  if (a.is_round) {
    const double swing = a.swing_beside(b);
    of_turn = std::min(of_turn, (relative + own + swing) * swing);
  }
  return 0.125 * (of_centre + of_turn * a.radius);
}

Aabb box_of_piece(const MovingSolid& a, const MovingSolid& b) {
  Aabb box;
  const double bend = bend_between(a, b);
  for (const auto& [own, other] : {std::pair(a.first, b.first), std::pair(a.last, b.last)}) {
    const PlacedConvex seen = placed(*a.solid, seen_from(other, own));
    for (int k = 0; k < 3; ++k)
      for (const double sign : {-1.0, 1.0}) {
        Vec3 x = seen.pose.position;
        x[k] = farthest(seen, sign * Vec3::Unit(k))[k] + sign * bend;
        box.include(x);
      }
  }
  return box;
}

}  // namespace impinge
