// Where the time of a frame goes. Measured for reports only: nothing the model computes depends on it.
#pragma once

#include <chrono>

namespace impinge {

struct StageTimes {
  double broad_ms = 0, narrow_ms = 0, assemble_ms = 0, response_ms = 0, integrate_ms = 0, step_ms = 0;
  double render_ms = 0;  ///< filled in by who draws the frame
  double guard_ms = 0;   ///< looks back at motions for what passed, and keeping what undoes them
};

/// Adds the milliseconds of its own life to a counter.
class StageTimer {
 public:
  explicit StageTimer(double& total_ms) : total_ms_(total_ms), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    total_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& total_ms_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace impinge
