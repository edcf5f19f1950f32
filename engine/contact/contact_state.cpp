#include "engine/contact/contact_state.hpp"

#include <cmath>

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

ContactState state_of(const Vec3& lambda, double friction) {
  if (lambda.x() <= 0.0) return ContactState::open;
  // the solver puts sliding contacts on the cone to rounding; frictionless contacts slide
  return std::hypot(lambda.y(), lambda.z()) >= friction * lambda.x() * (1.0 - 1e-9) ? ContactState::slip
                                                                                    : ContactState::stick;
}

}  // namespace impinge
