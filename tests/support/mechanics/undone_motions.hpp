// How often a sub-step was taken back because a surface would have passed through another.
#pragma once

#include "engine/step/step_watcher.hpp"

namespace impinge::test {

class UndoneMotions : public StepWatcher {
 public:
  int count = 0;
  void moved(const Bodies&, const SubStep&, MotionGuard&, const std::optional<UnsafeMotion>&, bool is_kept) override {
    count += is_kept ? 0 : 1;
  }
};

}  // namespace impinge::test
