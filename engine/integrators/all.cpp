// The lists of integrators, of rigid and of deformable bodies: one line each.
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/integrators/integrator.hpp"

namespace impinge {

Entry<Integrator> linearly_implicit_euler_integrator();
Entry<Integrator> symplectic_euler_integrator();

const Registry<Integrator>& integrators() {
  static const Registry<Integrator> list = {linearly_implicit_euler_integrator(), symplectic_euler_integrator()};
  return list;
}

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
