// Frames that nobody will wait for, by the sub-step that was tried.
#include <fmt/format.h>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kSlow = 10.0;  // seconds a frame: 240 of them are 40 minutes

class SlowFrame : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    if (start.trial == nullptr || start.trial->frame_seconds() < kSlow) return {};
    const Trial& t = *start.trial;
    const char* remedy = "take coarser surfaces or volumes, or fewer sub-steps";
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
  return entry<Warning, SlowFrame>("slow-frame", "with --trial: a frame takes over ten seconds as the scene starts");
}

}  // namespace impinge
