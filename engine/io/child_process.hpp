// A program that runs beside this one and does not outlive what it works for.
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace impinge {

/// Starts the program words[0], looked for on PATH if that is a bare name, without a shell. No signal is blocked in it,
/// whatever this program has blocked. 0, or the system's error number.
int spawn(const std::vector<std::string>& words, const posix_spawn_file_actions_t& streams, pid_t& pid);

class ChildProcess {
 public:
  /// Takes over a process that was just started.
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  /// Kills it, unless its end was waited for.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    std::swap(pid_, other.pid_);
    return *this;
  }

  /// What it writes into the pipe `end` until it closes it, the first `most` bytes of that; closes `end`. Throws
  /// Interrupted.
  static std::string read_all(int end, std::size_t most = std::string::npos);
  /// Its wait status once it has ended. Throws Interrupted.
  int wait();
  /// The same without waiting: nothing while it runs.
  std::optional<int> poll();
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_;
};

}  // namespace impinge
