#include "engine/step/free_velocities.hpp"

#include "engine/step/tasks.hpp"

namespace impinge {

void find_free_velocities(Bodies& bodies, const TimeIntegration& how) {
  for_each_active(bodies, [&](BodyIndex, Body& body) {
    body.open_sub_step();
    if (body.has_freedom() && !body.asleep) body.find_free_velocity(how);
  });
}

}  // namespace impinge
