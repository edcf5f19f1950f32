#include "viewer/controller/interrupt.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <string>
#include <thread>

namespace impinge {
namespace {

constexpr int kExitCode = 130;

std::atomic<bool> g_interrupted{false};
std::atomic<const char*> g_what{"ending within 2 s"};
std::atomic<long> g_limit_ms{1300};

/// To stderr, as far as that goes, in one piece.
void say(const std::string& text) {
  // what a progress line left on the terminal's last line goes
  const std::string line = (isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "") + text + "\n";
  const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
  (void)written;  // nobody is left to tell
}

/// A thread rather than a handler: a handler is taken away by whoever sets one of his own, as METIS does with SIGTERM
/// while it orders a matrix, which it then gives up, so that the run goes on to other bits.
void serve(const sigset_t& signals) {
  pthread_setname_np(pthread_self(), "signals");
  int signal = 0;
  while (sigwait(&signals, &signal) != 0) {
  }
  say(std::string("interrupted: ") + g_what.load() + "; a second one ends at once");
  g_interrupted = true;  // now: who sees it may end the program before a line that came later
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::milliseconds(g_limit_ms.load());
  int second = -1;
  do {  // again: a stop and a continue end a wait without a signal
    const auto left = std::max<std::chrono::nanoseconds>(end - Clock::now(), std::chrono::nanoseconds(0)).count();
    const timespec rest{left / 1'000'000'000, left % 1'000'000'000};
    second = sigtimedwait(&signals, nullptr, &rest);
  } while (second < 0 && errno == EINTR);
  if (second < 0) say("interrupted: ended in the middle of a long stage; what was finished before is kept");
  _exit(kExitCode);
}

}  // namespace

void watch_for_interrupt() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(serve, signals).detach();
}

void explain_interrupt(const char* what) { g_what = what; }
void limit_interrupt(double seconds) { g_limit_ms = static_cast<long>(1e3 * seconds); }
const std::atomic<bool>& interrupted() { return g_interrupted; }

}  // namespace impinge
