// What thresholds that are left to the program ("auto") are parts of where two bodies meet.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/contact/contact_scale.hpp"

namespace impinge {

/// The size of the smaller of both, metres. A sheet that lies still counts: nothing should be felt through it.
double pair_size(const Body& a, const Body& b);

/// Length: pair_size. Speed: √(g·size) of the smaller of those that move freely; what is fixed or driven has a size, but
/// no motion of its own that gravity could be the measure of. `gravity`: of scale_gravity, m/s².
ContactScale pair_scale(const Body& a, const Body& b, double gravity);

}  // namespace impinge
