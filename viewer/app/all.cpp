// The list of commands: one line each, in the order of --help.
#include "viewer/app/sub_command.hpp"

namespace impinge {

const Registry<SubCommand>& sub_commands() {
  static const Registry<SubCommand> list = [] {
    Registry<SubCommand> all;
    IMPINGE_LIST(all, run_command);
    IMPINGE_LIST(all, replay_command);
    IMPINGE_LIST(all, diff_command);
    IMPINGE_LIST(all, check_command);
    IMPINGE_LIST(all, info_command);
    IMPINGE_LIST(all, why_command);
    IMPINGE_LIST(all, mesh_command);
    IMPINGE_LIST(all, list_command);
    IMPINGE_LIST(all, step_command);
    IMPINGE_LIST(all, verify_command);
    IMPINGE_LIST(all, test_command);
    IMPINGE_LIST(all, compare_command);
    IMPINGE_LIST(all, export_command);
    IMPINGE_LIST(all, debug_command);
    IMPINGE_LIST(all, shrink_command);
    IMPINGE_LIST(all, sweep_command);
    IMPINGE_LIST(all, clean_command);
    return all;
  }();
  return list;
}

}  // namespace impinge
