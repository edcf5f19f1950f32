// What a group's velocities are known to: a residual below it is rounding, and contradicts nothing.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

/// Speeds are rounded, and positions where they stand: rows that take gaps or drifts back within Δt ask for that by Δt, m/s. So two points
/// of a hinge, each a last digit off its place, ask a rigid body to stretch.
double rounding_speed(const Bodies& bodies, const AssembledGroup& group, double time_step);

}  // namespace impinge
