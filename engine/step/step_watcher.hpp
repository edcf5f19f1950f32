// Whoever looks on while a frame is made, sub-step by sub-step. Watching changes nothing.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/step/motion_guard.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

class StepWatcher {
 public:
  virtual ~StepWatcher() = default;
  /// A motion begins: contacts are found, nothing has moved since. What `step` refers to belongs to this instant.
  virtual void found(const Bodies&, const SubStep& /*step*/) {}
  /// It is made and was looked back at. Not kept: the bodies go back to where it began, and a shorter one follows.
  virtual void moved(const Bodies&, const SubStep& /*step*/, MotionGuard& /*guard*/,
                     const std::optional<UnsafeMotion>& /*unsafe*/, bool /*is_kept*/) {}
  /// A sub-step of the frame, from 1 on, is whole.
  virtual void finished(const Bodies&, int /*substep*/) {}
  /// Whether to look for passages where narrow_phase.continuous = "off" leaves that out.
  virtual bool wants_passages() const { return false; }
};

}  // namespace impinge
