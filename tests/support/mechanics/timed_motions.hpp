// Motions whose truth in time is known, by a formula or by a far finer step: how far off a run is says of which order the
// time integration is in them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/world/world.hpp"

namespace impinge::test {

/// What a motion is run with.
struct TimedBy {
  int substeps = 4;  ///< of 1/60 s
  std::function<void(World&)> settings = [](World&) {};
};

struct TimedMotion {
  std::string name;
  std::string unit;  ///< of the error
  bool is_soft;      ///< of deformable bodies: those of every integrator differ
  std::function<double(const TimedBy&)> error;
};

/// All of them; each error is a root mean square over several starts where one start may be lucky.
const std::vector<TimedMotion>& timed_motions();
const TimedMotion& timed_motion(const std::string& name);

/// How many times smaller errors get when steps are halved, as a power of two: by least squares over errors at 4, 8, 16, …
double observed_order(const std::vector<double>& errors);

/// A bar on a point of the world, let go at an angle: what is left of its swing after `seconds`, as a share.
double swing_left(const TimedBy& by, double seconds);

}  // namespace impinge::test
