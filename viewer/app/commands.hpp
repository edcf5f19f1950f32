// One function a sub-command: prints what it has to say and returns the exit code. They throw InputError and
// DivergenceError; main turns those into messages.
#pragma once

#include "viewer/app/arguments.hpp"

namespace impinge {

int run_command(const Arguments& arguments);
int replay_command(const Arguments& arguments);
int diff_command(const Arguments& arguments);
int check_command(const Arguments& arguments);
int info_command(const Arguments& arguments);
int list_command(const Arguments& arguments);
/// What `impinge list` has a list of.
std::vector<std::string> list_topics();
int step_command(const Arguments& arguments);
int sweep_command(const Arguments& arguments);
int debug_command(const Arguments& arguments);
int test_command(const Arguments& arguments);
int compare_command(const Arguments& arguments);

}  // namespace impinge
