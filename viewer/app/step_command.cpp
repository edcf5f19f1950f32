// impinge step: one problem, solved by every method, all judged by the same residual.
#include "engine/frozen/frozen_step_file.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/app/step_methods.hpp"

namespace impinge {

int step_command(const Arguments& arguments) {
  return is_frozen_step(arguments.a) ? step_frozen(arguments) : step_published(arguments);
}

}  // namespace impinge
