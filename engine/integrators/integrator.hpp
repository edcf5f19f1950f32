// The list of time integrators. Each says what A v = b and Δq(v) are for a deformable body; for rigid bodies, where A =
// M and b = M v + Δt f, all of them are the same map (rigid_motion.hpp).
#pragma once

#include "engine/integrators/deformable_integrator.hpp"

namespace impinge {

inline const Registry<DeformableIntegrator>& integrators() { return deformable_integrators(); }

}  // namespace impinge
