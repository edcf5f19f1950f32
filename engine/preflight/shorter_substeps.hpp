#pragma once

#include <string>

#include "engine/world/parameters.hpp"

namespace impinge {

/// What makes sub-steps at least `times` as short, as a user would set it.
std::string shorter_substeps(const Parameters& parameters, double times);

/// Of a sub-step: the damping beta with which newmark never won energy in contact (tests/README.md, "Newmark in contact").
inline constexpr double kEnoughDamping = 0.25;
/// "material.damping = [0, 0.0011]": as much or a little more, as a user would set it.
std::string enough_damping(const Parameters& parameters);

}  // namespace impinge
