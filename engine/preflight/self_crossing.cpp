// A surface that meets itself and crosses itself at the start: both sides push on the wrong one.
#include <fmt/format.h>

#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

class SelfCrossing : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const std::int64_t count = start.world.record().stats.self_crossings;
    if (count == 0) return {};
    return {{fmt::format("{} pairs of triangles of bodies with self_collision cross", count),
             "self_exempt_distance leaves such parts out"}};
  }
};

}  // namespace

Entry<Warning> self_crossing_warning() {
  return entry<Warning, SelfCrossing>("self-crossing", "a body with self_collision crosses itself at the start");
}

}  // namespace impinge
