#include "viewer/debugger/window_loop.hpp"

#include <chrono>
#include <thread>

namespace impinge {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kNowAndThen(3.0);
constexpr int kIdle = 50;  // ms to wait for input where nothing moves

}  // namespace

void show_on_screens(DebugLoop& loop, DebugWindow& pixels, std::span<const std::unique_ptr<Screen>> screens,
                     const std::atomic<bool>& interrupted, const std::function<void()>& now_and_then) {
  const int patience = kIdle / static_cast<int>(screens.size());
  Image image;
  Clock::time_point called = Clock::now();
  while (!loop.has_quit() && !interrupted) {
    const Clock::time_point start = Clock::now();
    bool open = true, exposed = false;
    for (const auto& screen : screens) open &= screen->take_input(pixels.ui(), loop.is_busy() ? 0 : patience);
    loop.tick();
    for (const auto& screen : screens) exposed |= screen->is_exposed();
    if (pixels.has_changed() || exposed) {
      pixels.read(image);
      for (const auto& screen : screens) screen->show(image);
    }
    if (start - called > kNowAndThen) now_and_then(), called = start;
    if (!open) break;
    const Seconds left = Seconds(loop.seconds_to_show()) - (Clock::now() - start);
    if (left > Seconds::zero()) std::this_thread::sleep_for(left);
  }
}

}  // namespace impinge
