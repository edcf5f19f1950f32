// The list of integrators: one line each.
#include "engine/integrators/integrator.hpp"

namespace impinge {

Entry<Integrator> linearly_implicit_euler_integrator();
Entry<Integrator> symplectic_euler_integrator();

const Registry<Integrator>& integrators() {
  static const Registry<Integrator> list = {linearly_implicit_euler_integrator(), symplectic_euler_integrator()};
  return list;
}

}  // namespace impinge
