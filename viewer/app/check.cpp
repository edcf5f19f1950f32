// impinge check
#include <fmt/format.h>

#include "viewer/app/commands.hpp"
#include "viewer/study/soft_report.hpp"

namespace impinge {

int check_command(const Arguments& arguments) {
  const RunOptions& options = arguments.run_options;
  const Session session(options.scene, options.overrides, options.script, {.judge = true});
  fmt::print("{}: {} bodies, {} surface files, no problems found\n", options.scene.string(),
             session.world().bodies().size(), session.scene().surfaces.size());
  print_soft_bodies(session);
  return 0;
}

}  // namespace impinge
