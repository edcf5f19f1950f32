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

Vec3 tangent1(const Vec3& normal) {
  int axis = 0;  // the first of the world axes along which the normal is smallest
  for (int k = 1; k < 3; ++k)
    if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
  return Vec3::Unit(axis).cross(normal).normalized();
}

}  // namespace impinge
