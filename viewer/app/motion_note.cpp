#include "viewer/app/motion_note.hpp"

#include <fmt/format.h>

namespace impinge {

void MotionNote::add(const FrameStats& stats) {
  if (stats.unsafe_motions == 0) return;
  bodies_.insert(stats.unsafe.begin(), stats.unsafe.end());
  if (frames_++ == 0) first_frame_ = stats.frame;
}

std::string MotionNote::text() const {
  if (frames_ == 0) return "";
  constexpr std::size_t kNamed = 4;
  std::string names;
  std::size_t left = bodies_.size();
  for (const std::string& name : bodies_) {
    if (bodies_.size() - left == kNamed) break;
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name);
    --left;
  }
  if (left > 0) names += fmt::format(" and {} more", left);
  return fmt::format(
      "note:     {} may have passed through others, in {} frame{}, the first {}; more sub-steps help, and "
      "narrow_phase.continuous = \"auto\" or \"on\" where it is off\n",
      names, frames_, frames_ == 1 ? "" : "s", first_frame_);
}

}  // namespace impinge
