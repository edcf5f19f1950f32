// impinge: one program, one sub-command a job. What goes wrong becomes one message on stderr and an exit code:
// 2 the input is wrong, 3 the simulation diverged, 4 a bug of ours.
#include <csignal>
#include <cstdio>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "viewer/app/commands.hpp"

namespace {

int dispatch(const impinge::Arguments& arguments) {
  using impinge::Arguments;
  switch (arguments.kind) {
    case Arguments::run:
      return impinge::run_command(arguments);
    case Arguments::replay:
      return impinge::replay_command(arguments);
    case Arguments::diff:
      return impinge::diff_command(arguments);
    case Arguments::check:
      return impinge::check_command(arguments);
    case Arguments::info:
      return impinge::info_command(arguments);
    case Arguments::list:
      return impinge::list_command(arguments);
    case Arguments::step:
      return impinge::step_command(arguments);
    case Arguments::sweep:
      return impinge::sweep_command(arguments);
    case Arguments::debug:
      return impinge::debug_command(arguments);
    case Arguments::test:
      return impinge::test_command(arguments);
    case Arguments::compare:
      return impinge::compare_command(arguments);
    case Arguments::print:
      std::fputs(arguments.text.c_str(), stdout);
      return 0;
  }
  return 4;
}

int fail(int code, const char* kind, const char* what) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s%s\n", kind, what);
  return code;
}

}  // namespace

int main(int count, char** words) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes then shows as a failed write, which says what to do
  try {
    const impinge::Arguments arguments = impinge::parse_arguments(count, words);
    impinge::set_thread_count(arguments.threads);
    return dispatch(arguments);
  } catch (const impinge::InputError& error) {
    return fail(2, "", error.what());
  } catch (const impinge::DivergenceError& error) {
    return fail(3, "diverged: ", error.what());
  } catch (const std::bad_alloc&) {
    return fail(2, "", "out of memory: the scene needs more than this machine has; make it smaller");
  } catch (const std::exception& error) {
    return fail(4, "a bug of impinge: ", error.what());
  }
}
