// What a sub-step of a scene takes, by making one.
#pragma once

#include <functional>
#include <string>

#include "engine/world/step_record.hpp"

namespace impinge {

struct Trial {
  bool ended = true;       ///< false: given up after `seconds`
  double seconds = 0.0;    ///< of a sub-step
  double bytes = 0.0;      ///< resident after it
  int substeps = 1;        ///< of a frame
  std::string_view stage;  ///< that took longest
  double share = 0.0;      ///< of the sub-step, of that stage
  FrameStats stats = {};   ///< what came of it
  std::string diverged;    ///< why, if it left the finite numbers
  double frame_seconds() const { return seconds * substeps; }
};

/// Calls `step`, which makes `made` sub-steps, and once more if that went quickly: the first one also makes what is kept.
/// Gives up after `most_seconds`. Throws Interrupted if whoever lent the flag (core/interrupt.hpp) wants that.
Trial try_sub_steps(const std::function<const FrameStats&()>& step, int made, double most_seconds);

}  // namespace impinge
