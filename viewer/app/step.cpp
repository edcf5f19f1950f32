// impinge step: one problem, solved by every method, all judged by the same residual.
#include "engine/frozen/frozen_step_file.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/study/methods.hpp"

namespace impinge {

int step_command(const Arguments& arguments) {
  const StepOptions options{
      arguments.a,  arguments.responses, arguments.lcp, arguments.step_tolerance, arguments.max_iterations,
      arguments.out};
  is_frozen_step(options.file) ? step_frozen(options) : step_published(options);
  return 0;
}

}  // namespace impinge
