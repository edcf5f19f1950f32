#include "viewer/app/frame_progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace impinge {

void FrameProgress::show(int frame, int last, const std::string& more) {
  using Seconds = std::chrono::duration<double>;
  const Clock::time_point now = Clock::now();
  if (last != last_ || frame <= frame_) start_ = shown_at_ = now, first_ = frame, last_ = last;
  frame_ = frame;
  if (Seconds(now - shown_at_).count() < 0.1) return;
  shown_at_ = now;
  shown_ = true;
  fmt::print(stderr, "\rframe {}/{}{}  {:.0f} s left\x1b[K", frame, last, more,
             Seconds(now - start_).count() / (frame - first_) * (last - frame));
  std::fflush(stderr);
}

void FrameProgress::clear() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
  shown_ = false;
}

}  // namespace impinge
