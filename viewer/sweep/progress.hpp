// One line on a terminal: how far a sweep is, and how long it takes at the present pace.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

namespace impinge {

class SweepProgress {
 public:
  SweepProgress(std::size_t jobs, bool shows) : jobs_(jobs), shows_(shows) {}
  void ended(bool was_run) { was_run ? ++run_ : ++skipped_; }
  /// Instead of ended(), for whoever counts himself.
  void set_run(std::size_t run) { run_ = run; }
  void show(std::size_t running) {
    if (!shows_) return;
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - last_).count() < 0.2) return;
    last_ = now;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    const std::size_t done = run_ + skipped_;
    fmt::print(stderr, "\rjobs {}/{}  running {}{}\x1b[K", done, jobs_, running,
               run_ > 0 ? fmt::format("  {:.0f} s left",
                                      seconds / static_cast<double>(run_) * static_cast<double>(jobs_ - done))
                        : "");
    std::fflush(stderr);
  }
  void clear() const {
    if (shows_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  std::size_t jobs_, run_ = 0, skipped_ = 0;
  bool shows_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_;
};

}  // namespace impinge
