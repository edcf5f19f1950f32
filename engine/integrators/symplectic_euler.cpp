// The explicit baseline: velocities from the forces at the start, positions from the new velocities.
#include "engine/integrators/rigid_integrator.hpp"

namespace impinge {

Entry<Integrator> symplectic_euler_integrator() {
  return entry<Integrator, RigidIntegrator>("symplectic_euler", "explicit baseline: new velocity first, then position");
}

}  // namespace impinge
