#include "engine/contact/pair_coefficients.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {

double pair_friction(const Body& a, const Body& b, const ContactSettings& scene) {
  return std::sqrt(a.friction.value_or(scene.friction) * b.friction.value_or(scene.friction));
}

double pair_restitution(const Body& a, const Body& b, const ContactSettings& scene) {
  return std::max(a.restitution.value_or(scene.restitution), b.restitution.value_or(scene.restitution));
}

}  // namespace impinge
