// A line of a terminal that says how far a run or a long seek is, with the time left.
#pragma once

#include <chrono>
#include <string>

namespace impinge {

class FrameProgress {
 public:
  /// Says nothing in the first tenth of a second. A smaller frame, or another `last`, begins anew.
  void show(int frame, int last, const std::string& more = "");
  /// Before anything else is printed, and at the end.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_, shown_at_;
  int first_ = 0, frame_ = 0, last_ = -1;
  bool shown_ = false;
};

}  // namespace impinge
