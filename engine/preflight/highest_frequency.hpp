// The highest frequency of a deformable body at rest: what an explicit scheme's time step is limited by.
#pragma once

#include "engine/bodies/deformable_body.hpp"

namespace impinge {

/// ω of the stiffest mode of M⁻¹ K over the nodes that aren't held, rad/s, from below by power iteration to a part in
/// a thousand; 0 where every node is held.
double highest_frequency(const DeformableBody& body);

}  // namespace impinge
