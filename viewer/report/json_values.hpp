// Numbers as JSON has them.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "engine/core/parameter.hpp"

namespace impinge {

/// JSON has no infinity: a plane's box ends nowhere. A zero has no sign.
inline std::string json_number(double x) { return std::isfinite(x) ? shortest(x + 0.0) : "null"; }
inline std::string json_vector(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", json_number(v.x()), json_number(v.y()), json_number(v.z()));
}

}  // namespace impinge
