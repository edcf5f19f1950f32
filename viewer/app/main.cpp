// impinge: one program, one sub-command a job. What goes wrong becomes one message on stderr and an exit code:
// 2 the input is wrong, 3 the simulation diverged, 4 a bug of ours.
#include <csignal>
#include <cstdio>

#include "viewer/app/sub_command.hpp"

namespace {

int fail(int code, const char* kind, const char* what) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s%s\n", kind, what);
  return code;
}

}  // namespace

int main(int count, char** words) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes then shows as a failed write, which says what to do
  try {
    return impinge::run_command_line(count, words);
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
