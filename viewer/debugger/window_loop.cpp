#include "viewer/debugger/window_loop.hpp"

#include <chrono>
#include <thread>

#include "viewer/present/window.hpp"

namespace impinge {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kNowAndThen(3.0);
constexpr int kIdle = 50;  // ms to wait for input where nothing moves

}  // namespace

void show_window(DebugLoop& loop, DebugWindow& pixels, const std::string& title, const std::atomic<bool>& interrupted,
                 const std::function<void()>& now_and_then) {
  Window window(pixels.width(), pixels.height(), title);
  Image image;
  Clock::time_point called = Clock::now();
  while (!loop.has_quit() && !interrupted) {
    const Clock::time_point start = Clock::now();
    const bool open = window.take_input(pixels.ui(), loop.is_busy() ? 0 : kIdle);
    loop.tick();
    if (pixels.has_changed() || window.is_exposed()) {
      pixels.read(image);
      window.show(image);
    }
    if (start - called > kNowAndThen) now_and_then(), called = start;
    if (!open) break;
    const Seconds left = Seconds(loop.seconds_to_show()) - (Clock::now() - start);
    if (left > Seconds::zero()) std::this_thread::sleep_for(left);
  }
}

}  // namespace impinge
