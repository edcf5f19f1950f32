// A body that lies wholly inside another at the start: nothing of their surfaces crosses, so pictures show nothing, and
// it is pushed out the shortest way.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

class BodyInside : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Bodies& bodies = start.world.bodies();
    std::vector<Enclosure> all = start.enclosures;
    std::stable_sort(all.begin(), all.end(), [](const auto& l, const auto& r) { return l.depth > r.depth; });
    std::vector<Finding> found;
    for (const Enclosure& e : all) {
      const bool is_below = bodies[e.outer].shape->as<Plane>() != nullptr;
      found.push_back({fmt::format("'{}' lies wholly {} '{}', {} deep or deeper", bodies[e.inner].name,
                                   is_below ? "below" : "inside", bodies[e.outer].name, length_text(e.depth)),
                       "move it out; or, if it is meant to be there, join the two by an attachment with collide = "
                       "false"});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> body_inside_warning() {
  return entry<Warning, BodyInside>("body-inside", "a body lies wholly inside another, or below a plane, at the start");
}

}  // namespace impinge
