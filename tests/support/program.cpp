#include "tests/support/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "tests/support/temp_folder.hpp"

namespace impinge::test {

namespace {

pid_t start(const std::filesystem::path& program, const std::filesystem::path& folder,
            const std::vector<std::string>& arguments, const std::filesystem::path& out,
            const std::filesystem::path& err) {
  std::vector<const char*> words = {program.c_str()};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process");
  if (pid > 0) return pid;
  const int o = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
            e = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (chdir(folder.c_str()) != 0 || dup2(o, STDOUT_FILENO) < 0 || dup2(e, STDERR_FILENO) < 0) _exit(127);
  execv(words[0], const_cast<char* const*>(words.data()));
  _exit(127);
}

Outcome finish(int status, const std::filesystem::path& out, const std::filesystem::path& err) {
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), slurp(out), slurp(err)};
}

std::vector<pid_t> children_of(pid_t pid) {
  std::ifstream list("/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) + "/children");
  return {std::istream_iterator<pid_t>(list), std::istream_iterator<pid_t>()};
}

}  // namespace

int Outcome::error_lines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }

Outcome program_run(const std::filesystem::path& program, const std::filesystem::path& folder,
                    const std::vector<std::string>& arguments) {
  const TempFolder streams;
  const pid_t pid = start(program, folder, arguments, streams / "out", streams / "err");
  int status = 0;
  waitpid(pid, &status, 0);
  return finish(status, streams / "out", streams / "err");
}

Outcome impinge_run(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
  return program_run(IMPINGE_PROGRAM, folder, arguments);
}

Outcome impinge_stopped(const std::filesystem::path& folder, const std::vector<std::string>& arguments, double seconds,
                        int signal, Targets targets) {
  const TempFolder streams;
  const pid_t pid = start(IMPINGE_PROGRAM, folder, arguments, streams / "out", streams / "err");
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() >= end) {
      if (targets == Targets::children_first)
        for (const pid_t child : children_of(pid)) kill(child, signal);
      kill(pid, signal);
      waitpid(pid, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return finish(status, streams / "out", streams / "err");
}

}  // namespace impinge::test
