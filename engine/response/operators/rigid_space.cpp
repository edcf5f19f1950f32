#include "engine/response/operators/rigid_space.hpp"

namespace impinge {

BodySpace rigid_space(const GroupSystem& group) {
  BodySpace space;
  for (const RigidBlock& block : group.rigid) {
    space.mass.push_back(1.0 / block.inverse_mass);
    space.inertia.push_back(block.inverse_inertia.inverse());
  }
  for (const ContactRows& rows : group.contacts) {
    std::array<BodySpace::Side, 2>& sides = space.sides.emplace_back();
    const ContactSide* of[2] = {&rows.a, &rows.b};
    for (int s = 0; s < 2; ++s) {
      if (of[s]->rigid < 0) continue;
      const double sign = s == 0 ? 1.0 : -1.0;
      sides[s].body = of[s]->rigid;
      for (int k = 0; k < (rows.has_one_row() ? 1 : 3); ++k) {
        sides[s].row[k].head<3>() = sign * rows.directions.row(k);
        sides[s].row[k].tail<3>() = sign * of[s]->arm.cross(rows.directions.row(k).transpose());
      }
    }
  }
  return space;
}

}  // namespace impinge
