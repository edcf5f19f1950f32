// What a run must not keep to its table: bodies whose motion may have taken them through others.
#pragma once

#include <set>

#include "engine/world/step_record.hpp"

namespace impinge {

class MotionNote {
 public:
  void add(const FrameStats& stats);
  /// One line with its end, "" if every motion was safe.
  std::string text() const;

 private:
  std::set<std::string> bodies_;
  int frames_ = 0, first_frame_ = 0;
};

}  // namespace impinge
