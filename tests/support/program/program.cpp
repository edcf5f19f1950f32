#include "tests/support/program/program.hpp"

#include <fcntl.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace impinge::test {

namespace {

/// What root has beside a user's rights is gone for programs that this process becomes; no other process is changed.
bool lose_rights() {
  if (geteuid() != 0) return true;
  return prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE) == 0 && prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH) == 0;
}

std::vector<pid_t> children_of(pid_t pid) {
  std::ifstream list("/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) + "/children");
  return {std::istream_iterator<pid_t>(list), std::istream_iterator<pid_t>()};
}

}  // namespace

int Outcome::error_lines() const { return static_cast<int>(std::count(err.begin(), err.end(), '\n')); }

bool can_lose_rights() {
  const TempFolder folder;
  const std::filesystem::path file = folder.write("closed", "x");
  if (chmod(file.c_str(), 0) != 0) return false;
  const pid_t pid = fork();
  if (pid < 0) return false;
  if (pid == 0) {
    if (!lose_rights()) _exit(3);
    execl("/bin/cat", "cat", file.c_str(), nullptr);
    _exit(2);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 1;  // cat was refused
}

RunningProgram::RunningProgram(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                               const Surroundings& surroundings, const std::filesystem::path& program) {
  std::vector<const char*> words = {program.c_str()};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  const std::filesystem::path out = surroundings.out.empty() ? streams_ / "out" : surroundings.out,
                              err = streams_ / "err";
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no process");
  if (pid_ > 0) return;
  const int o = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
            e = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (chdir(folder.c_str()) != 0 || dup2(o, STDOUT_FILENO) < 0 || dup2(e, STDERR_FILENO) < 0) _exit(127);
  if (surroundings.in_removed_folder && rmdir(folder.c_str()) != 0) _exit(127);
  if (surroundings.without_rights && !lose_rights()) _exit(127);
  execv(words[0], const_cast<char* const*>(words.data()));
  _exit(127);
}

RunningProgram::~RunningProgram() {
  if (has_ended()) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, &status_, 0);
}

void RunningProgram::signal(int number) const {
  if (!ended_) kill(pid_, number);
}

bool RunningProgram::has_ended() {
  if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

Outcome RunningProgram::wait() {
  if (!ended_) waitpid(pid_, &status_, 0);
  ended_ = true;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_), slurp(streams_ / "out"),
          slurp(streams_ / "err")};
}

Outcome program_run(const std::filesystem::path& program, const std::filesystem::path& folder,
                    const std::vector<std::string>& arguments) {
  return RunningProgram(folder, arguments, {}, program).wait();
}

Outcome impinge_run(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                    const Surroundings& surroundings) {
  return RunningProgram(folder, arguments, surroundings).wait();
}

Outcome impinge_stopped(const std::filesystem::path& folder, const std::vector<std::string>& arguments, double seconds,
                        int signal, Targets targets) {
  RunningProgram program(folder, arguments);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!program.has_ended()) {
    if (std::chrono::steady_clock::now() >= end) {
      if (targets == Targets::children_first)
        for (const pid_t child : children_of(program.pid())) kill(child, signal);
      program.signal(signal);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return program.wait();
}

Outcome impinge_watched(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                        const std::function<void(pid_t)>& look) {
  RunningProgram program(folder, arguments);
  while (!program.has_ended()) {
    look(program.pid());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return program.wait();
}

}  // namespace impinge::test
