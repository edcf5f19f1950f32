// Stages 3 and 4 of a sub-step: forces, A and b of each body, and v* = A⁻¹ b, as if nothing touched it.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/bodies/time_integration.hpp"

namespace impinge {

/// Bodies are independent, so threads share them. Sleeping ones are passed over.
void find_free_velocities(Bodies& bodies, const TimeIntegration& how);

}  // namespace impinge
