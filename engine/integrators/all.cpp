// The list of integrators: one line each.
#include "engine/integrators/deformable_integrator.hpp"

namespace impinge {

Entry<DeformableIntegrator> deformable_linearly_implicit_euler();
Entry<DeformableIntegrator> deformable_implicit_euler();
Entry<DeformableIntegrator> deformable_newmark();
Entry<DeformableIntegrator> deformable_symplectic_euler();

const Registry<DeformableIntegrator>& deformable_integrators() {
  static const Registry<DeformableIntegrator> list = {deformable_linearly_implicit_euler(), deformable_implicit_euler(),
                                                      deformable_newmark(), deformable_symplectic_euler()};
  return list;
}

}  // namespace impinge
