// The list of integrators: one line each. The first is the default.
#include "engine/integrators/deformable_integrator.hpp"

namespace impinge {

const Registry<DeformableIntegrator>& integrators() {
  static const Registry<DeformableIntegrator> list = [] {
    Registry<DeformableIntegrator> all;
    IMPINGE_LIST(all, linearly_implicit_euler_integrator);
    IMPINGE_LIST(all, implicit_euler_integrator);
    IMPINGE_LIST(all, newmark_integrator);
    IMPINGE_LIST(all, energy_momentum_integrator);
    IMPINGE_LIST(all, symplectic_euler_integrator);
    return all;
  }();
  return list;
}

}  // namespace impinge
