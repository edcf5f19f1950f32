#include "engine/world/step_record.hpp"

namespace impinge {

const char* state_name(ContactState state) {
  switch (state) {
    case ContactState::open:
      return "open";
    case ContactState::stick:
      return "stick";
    case ContactState::slip:
      return "slip";
  }
  return "";
}

void count_unsolved(std::vector<UnsolvedGroups>& all, const UnsolvedGroups& more) {
  for (UnsolvedGroups& known : all)
    if (known.reason == more.reason && known.limit == more.limit) {
      known.solves += more.solves;
      return;
    }
  all.push_back(more);
}

Vec3 tangent1(const Vec3& normal) {
  int axis = 0;  // the first of the world axes along which the normal is smallest
  for (int k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
  return Vec3::Unit(axis).cross(normal).normalized();
}

}  // namespace impinge
