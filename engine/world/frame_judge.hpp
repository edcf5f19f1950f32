// The judge of `--judge`, at the end of each frame or of each sub-step, and what it finds as figures of the frame.
#pragma once

#include "engine/step/step_watcher.hpp"
#include "engine/world/judge.hpp"

namespace impinge {

class FrameJudge : public StepWatcher {
 public:
  enum When { each_frame, each_substep };
  explicit FrameJudge(When when) : when_(when) {}
  void finished(const Bodies& bodies, int substep) override;
  bool wants_passages() const override { return true; }
  /// The frame's figures: of its end, or the largest of its sub-steps. Begins anew.
  void judge(const Bodies& bodies, FrameStats& stats);

 private:
  void add(const Bodies& bodies, int substep);

  When when_;
  JudgeMemory memory_;
  OverlapVerdict worst_;
  std::int64_t self_crossings_ = 0;
  bool has_looked_ = false;
};

}  // namespace impinge
