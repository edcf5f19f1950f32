#include "viewer/debugger/window_loop.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "engine/core/interrupt.hpp"

namespace impinge {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kNowAndThen(3.0);
constexpr int kIdle = 50;             // ms to wait for input where nothing moves
constexpr Seconds kPauseEvery(0.02);  // of what is computed
constexpr Seconds kClock(0.25);       // how often the time that it takes is drawn, with nothing else to show

/// Makes a pause due again and again.
class Metronome {
 public:
  explicit Metronome(Pause& pause) : pause_(pause), thread_([this] { run(); }) {}
  ~Metronome() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

 private:
  void run() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, kPauseEvery, [this] { return ended_; })) pause_.is_due = true;
  }

  Pause& pause_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::thread thread_;
};

/// The debugger and what shows it.
class Show {
 public:
  Show(DebugLoop& loop, DebugWindow& pixels, std::span<const std::unique_ptr<Screen>> screens,
       const std::atomic<bool>& interrupted)
      : loop_(loop), pixels_(pixels), screens_(screens), interrupted_(interrupted) {
    pause_.take = [this] { meanwhile(); };
  }

  /// False once it is to be closed.
  bool tick() {
    const bool open = take_input(loop_.is_busy() ? 0 : kIdle / static_cast<int>(screens_.size()));
    begun_ = shown_ = Clock::now();
    frame_ = -1;
    stop_ = false;
    {
      const InterruptScope may_stop(&stop_);
      const PauseScope pauses(&pause_);
      try {
        loop_.tick();
      } catch (const Interrupted&) {  // ended where there was nothing to take back
        if (interrupted_) throw;
      }
    }
    show();
    return open && !is_closed_;
  }
  Pause& pause() { return pause_; }

 private:
  bool take_input(int milliseconds) {
    bool open = true;
    for (const auto& screen : screens_) open &= screen->take_input(pixels_.ui(), milliseconds);
    return open;
  }

  void show() {
    bool exposed = false;
    for (const auto& screen : screens_) exposed |= screen->is_exposed();
    if (!pixels_.has_changed() && !exposed) return;
    pixels_.read(image_);
    for (const auto& screen : screens_) screen->show(image_);
  }

  /// In a pause of what a tick computes.
  void meanwhile() {
    if (interrupted_) stop_ = true;
    if (!take_input(0)) is_closed_ = stop_ = true;
    const Clock::time_point now = Clock::now();
    if (loop_.frame() != frame_) frame_ = loop_.frame(), begun_ = now;
    if (!pixels_.ui().has_events() && now - shown_ < kClock) return;
    if (!loop_.tick_meanwhile(Seconds(now - begun_).count())) stop_ = true;
    show();
    shown_ = Clock::now();
  }

  DebugLoop& loop_;
  DebugWindow& pixels_;
  std::span<const std::unique_ptr<Screen>> screens_;
  const std::atomic<bool>& interrupted_;
  Image image_;
  Pause pause_;
  std::atomic<bool> stop_ = false;  // ends what a tick computes
  bool is_closed_ = false;
  int frame_ = -1;
  Clock::time_point begun_, shown_;
};

}  // namespace

void show_on_screens(DebugLoop& loop, DebugWindow& pixels, std::span<const std::unique_ptr<Screen>> screens,
                     const std::atomic<bool>& interrupted, const std::function<void()>& now_and_then) {
  Show show(loop, pixels, screens, interrupted);
  const Metronome metronome(show.pause());
  Clock::time_point called = Clock::now();
  while (!loop.has_quit() && !interrupted) {
    const Clock::time_point start = Clock::now();
    if (!show.tick()) break;
    if (start - called > kNowAndThen) now_and_then(), called = start;
    const Seconds left = Seconds(loop.seconds_to_show()) - (Clock::now() - start);
    if (left > Seconds::zero()) std::this_thread::sleep_for(left);
  }
}

}  // namespace impinge
