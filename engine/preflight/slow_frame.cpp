// Frames that nobody will wait for, by the sub-step that was tried and the frames after it.
#include <fmt/format.h>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kSlow = 10.0;  // seconds a frame: 240 of them are 40 minutes

class SlowFrame : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    if (start.trial == nullptr) return {};
    const Trial& t = *start.trial;
    // an explicit integrator has sub-steps for a reason (unstable-step)
    const bool may_have_fewer = !start.world.parameters.simulation.integrator->is_explicit();
    const char* remedy =
        may_have_fewer ? "take coarser surfaces or volumes, or fewer sub-steps" : "take coarser surfaces or volumes";
    if (t.frame_seconds() < kSlow && t.ahead.slowest() >= kSlow)
      return {{t.ahead.given_up > 0.0
                   ? fmt::format("frame {} was not done after {}", t.ahead.frames + 1, time_text(t.ahead.given_up))
                   : fmt::format("frame {} takes about {}, {:.0f} % of it the {}", t.ahead.dearest,
                                 time_text(t.ahead.dearest_seconds), 100.0 * t.ahead.share, t.ahead.stage),
               remedy}};
    if (t.frame_seconds() < kSlow) return {};
    if (!t.ended)
      return {{fmt::format("a sub-step was not done after {}, so a frame takes more than {}", time_text(t.seconds),
                           time_text(t.frame_seconds())),
               remedy}};
    return {{fmt::format("a frame takes about {}, {:.0f} % of it the {}", time_text(t.frame_seconds()), 100.0 * t.share,
                         t.stage),
             remedy}};
  }
};

}  // namespace

Entry<Warning> slow_frame_warning() {
  return entry<Warning, SlowFrame>("slow-frame",
                                   "with --trial: a frame takes over ten seconds, as the scene starts or soon after");
}

}  // namespace impinge
