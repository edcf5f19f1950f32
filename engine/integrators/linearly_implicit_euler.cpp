// The seed's scheme: backward Euler with one Newton iteration, A v* = b [Haapaoja16 §2.1].
#include "engine/integrators/rigid_integrator.hpp"

namespace impinge {

Entry<Integrator> linearly_implicit_euler_integrator() {
  return entry<Integrator, RigidIntegrator>("linearly_implicit_euler", "backward Euler with one Newton iteration (the seed's scheme)");
}

}  // namespace impinge
