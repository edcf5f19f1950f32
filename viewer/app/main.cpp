// impinge: one program, one sub-command a job. What goes wrong becomes one message on stderr and an exit code:
// 2 the input is wrong or the system refuses, 3 the simulation diverged, 4 a bug of ours, 130 interrupted.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "viewer/app/sub_command.hpp"
#include "viewer/controller/interrupt.hpp"

namespace {

int fail(int code, const char* kind, const std::string& what) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s%s\n", kind, what.c_str());
  return code;
}

/// What a command that got to its end, or was stopped by it, could not tell for want of room.
int refuse_stdout(int error) {
  std::fprintf(stderr, "stdout: can't be written (%s); free space or send it elsewhere\n", std::strerror(error));
  return 2;
}

std::string about(const std::filesystem::filesystem_error& error) {
  std::string where = error.path1().empty() ? "the present folder" : error.path1().string();
  if (!error.path2().empty()) where += " and " + error.path2().string();
  return where + ": can't be used (" + error.code().message() +
         "); a file system that answers is wanted; check permissions and paths";
}

/// A file that is opened must not get the number of a stream that whoever started us has closed: what is printed would
/// end up in it. Opened the wrong way round, so that its use is an error still.
void occupy_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int run_program(int count, char** words) {
  try {
    impinge::watch_for_interrupt();
    const impinge::InterruptScope scope(&impinge::interrupted());
    return impinge::run_command_line(count, words);
  } catch (const impinge::Interrupted&) {
    return 130;  // the line that answered the signal said it
  } catch (const impinge::InputError& error) {
    return fail(2, "", error.what());
  } catch (const impinge::DivergenceError& error) {
    return fail(3, "diverged: ", error.what());
  } catch (const std::bad_alloc&) {
    return fail(2, "", "out of memory: the scene needs more than this machine has; make it smaller");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, "", about(error));
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return refuse_stdout(error.code().value());
    return fail(2, "", std::string("the system refused: ") + error.what() + "; free what it lacks and run again");
  } catch (const std::exception& error) {
    return fail(4, "a bug of impinge: ", error.what());
  }
}

}  // namespace

int main(int count, char** words) {
  occupy_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes then shows as a failed write, which says what to do
  const int code = run_program(count, words);
  // a full disk may show only now; a command that failed has said why
  if (code > 1) return code;
  if (std::fflush(stdout) != 0) return refuse_stdout(errno);
  return std::ferror(stdout) != 0 ? refuse_stdout(ENOSPC) : code;  // nearly always
}
