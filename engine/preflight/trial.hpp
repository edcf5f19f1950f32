// What a sub-step of a scene takes, by making one; and what comes when bodies meet, by going on for a while.
#pragma once

#include <functional>
#include <string>

#include "engine/world/step_record.hpp"

namespace impinge {

/// Frames after the sub-step that was tried.
struct Ahead {
  int frames = 0;                ///< made whole, or diverged in
  double seconds = 0.0;          ///< that they took
  int dearest = 0;               ///< of them, from 1 on
  double dearest_seconds = 0.0;  ///< that it took
  std::string_view stage;        ///< of it that took longest
  double share = 0.0;            ///< of it, of that stage
  double given_up = 0.0;         ///< seconds spent in the frame after them that did not end; 0: there was time for all
  /// Of the slowest frame, as far as it went.
  double slowest() const { return dearest_seconds > given_up ? dearest_seconds : given_up; }
};

struct Trial {
  bool ended = true;       ///< false: given up after `seconds`
  double seconds = 0.0;    ///< of a sub-step
  double bytes = 0.0;      ///< resident after it
  int substeps = 1;        ///< of a frame
  std::string_view stage;  ///< that took longest
  double share = 0.0;      ///< of the sub-step, of that stage
  FrameStats stats = {};   ///< what came of it
  std::string diverged;    ///< why, if it left the finite numbers
  Ahead ahead = {};
  double frame_seconds() const { return seconds * substeps; }
};

/// Calls `step`, which makes `made` sub-steps, and once more if that went quickly: the first one also makes what is kept.
/// Gives up after `most_seconds`. Throws Interrupted if whoever lent the flag (core/interrupt.hpp) wants that.
Trial try_sub_steps(const std::function<const FrameStats&()>& step, int made, double most_seconds);

/// Calls `frame` up to `most_frames` times, until the deadline. What diverges ends it. Throws Interrupted as above.
Ahead look_ahead(const std::function<const FrameStats&()>& frame, int most_frames, double most_seconds);

}  // namespace impinge
