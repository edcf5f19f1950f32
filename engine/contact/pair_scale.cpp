#include "engine/contact/pair_scale.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/scale.hpp"

namespace impinge {

double pair_size(const Body& a, const Body& b) { return std::min(a.size, b.size); }

ContactScale pair_scale(const Body& a, const Body& b, double gravity) {
  const auto free_size = [](const Body& body) { return body.has_freedom() ? body.size : INFINITY; };
  return {pair_size(a, b), speed_scale(gravity, std::min(free_size(a), free_size(b)))};
}

}  // namespace impinge
