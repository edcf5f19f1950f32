#include "engine/io/child_process.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

#include "engine/core/interrupt.hpp"

extern char** environ;

namespace impinge {

namespace {

constexpr int kLookEvery = 20;  // ms between looks at the interrupt flag

}  // namespace

int spawn(const std::vector<std::string>& words, const posix_spawn_file_actions_t& streams, pid_t& pid) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int code = posix_spawnp(&pid, arguments[0], &streams, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  return code;
}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
}

std::string ChildProcess::read_all(int end, std::size_t most) {
  struct Closed {
    int end;
    ~Closed() { close(end); }
  } closed{end};
  std::string bytes;
  char buffer[65536];
  for (;;) {
    check_interrupt();
    pollfd ready{end, POLLIN, 0};
    if (::poll(&ready, 1, kLookEvery) <= 0) continue;  // a signal may end it, and a read would wait
    const ssize_t got = read(end, buffer, sizeof buffer);
    if (got > 0) bytes.append(buffer, std::min(static_cast<std::size_t>(got), most - bytes.size()));
    if (got == 0 || (got < 0 && errno != EINTR)) return bytes;
  }
}

std::optional<int> ChildProcess::poll() {
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  pid_ = -1;
  return status;
}

int ChildProcess::wait() {
  // a wait with an end to it doesn't exist: a short sleep at first, as most have closed their pipe and are about to end
  std::chrono::microseconds pause(100);
  for (;;) {
    if (const std::optional<int> status = poll()) return *status;
    check_interrupt();
    std::this_thread::sleep_for(pause);
    pause = std::min<std::chrono::microseconds>(2 * pause, std::chrono::milliseconds(kLookEvery));
  }
}

}  // namespace impinge
