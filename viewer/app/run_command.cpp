// impinge run
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "viewer/app/commands.hpp"

namespace impinge {

namespace {

std::atomic<bool> g_interrupted{false};

// the first signal ends the run after the frame in work, resumable; the second ends the program at once
void on_interrupt(int signal) {
  g_interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

class Progress {
 public:
  void show(const FrameStats& stats, int last_frame) {
    using Seconds = std::chrono::duration<double>;
    if (first_frame_ < 0) first_frame_ = stats.frame, start_ = Clock::now();
    const double elapsed = Seconds(Clock::now() - start_).count();
    const int done = stats.frame - first_frame_;
    const double left = done > 0 ? elapsed / done * (last_frame - stats.frame) : 0.0;
    if (shown_ && Seconds(Clock::now() - last_).count() < 0.1 && stats.frame < last_frame) return;
    last_ = Clock::now();
    shown_ = true;
    fmt::print(stderr, "\rframe {}/{}  contacts {}  {:.0f} s left\x1b[K", stats.frame, last_frame, stats.contacts, left);
    std::fflush(stderr);
  }
  void clear() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    shown_ = false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_, last_;
  int first_frame_ = -1;
  bool shown_ = false;
};

}  // namespace

int run_command(const Arguments& arguments) {
  const RunOptions& options = arguments.run_options;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  Progress progress;
  RunWatcher watcher;
  watcher.interrupted = &g_interrupted;
  if (!arguments.quiet && isatty(STDERR_FILENO))
    watcher.frame = [&](const FrameStats& stats, int last_frame) { progress.show(stats, last_frame); };
  watcher.message = [&](const std::string& line) {
    progress.clear();
    fmt::print(stderr, "{}\n", line);
  };
  const RunResult result = run(options, watcher);
  progress.clear();
  if (!result.diverged.empty()) fmt::print(stderr, "diverged: {}\n", result.diverged);
  if (result.interrupted) fmt::print(stderr, "interrupted after frame {}; the same command with --resume goes on\n", result.last_frame);
  if (arguments.quiet) return result.exit_code();

  if (result.resumed_from >= 0) fmt::print("resumed:  after frame {}\n", result.resumed_from);
  if (options.images && result.last_frame >= 0) fmt::print("pictures: {}/frames/000000.png ... {:06}.png\n", options.out.string(), result.last_frame);
  fmt::print("figures:  {}/stats.csv ({} frames)\n", options.out.string(), result.last_frame + 1);
  if (result.failures > 0) fmt::print("failed:   {} expectation{}\n", result.failures, result.failures == 1 ? "" : "s");
  return result.exit_code();
}

}  // namespace impinge
