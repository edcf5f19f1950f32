#include "engine/bodies/time_integration.hpp"

namespace impinge {

void NewtonSettings::declare(const Rows& rows) {
  rows.add("tolerance", tolerance, {1e-15, 1.0, true}, "",
           "Newton's method ends where the residual is this part of the momenta and impulses that make it up.");
  rows.add("max_iterations", max_iterations, {1, 1000000, true}, "",
           "Newton iterations at most, of a body by itself and of a group in contact, each sub-step.");
}

}  // namespace impinge
