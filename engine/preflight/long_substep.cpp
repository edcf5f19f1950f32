// Small bodies and long sub-steps: what a stack takes depends on how much of itself a body falls in one, g Δt²/size, and on
// nothing else. It was measured (tests/README.md, "What a response takes").
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/units.hpp"
#include "engine/preflight/shorter_substeps.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr int kFewest = 5;  // bodies that a stack is worth a word from

struct StackLimit {
  std::string_view response;
  double most;  // g Δt²/size with which ten cubes on one another move by no more than a tenth of one
};

constexpr StackLimit kStackLimits[] = {
    {"quick", 0.04}, {"simultaneous_impulse", 0.04}, {"soft_constraint", 4e-4}, {"penalty", 1e-3}};

class LongSubstep : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Parameters& p = start.world.parameters;
    const StackLimit* limit = std::find_if(std::begin(kStackLimits), std::end(kStackLimits),
                                           [&](const StackLimit& l) { return l.response == p.response.method.name(); });
    if (limit == std::end(kStackLimits)) return {};
    const double h = p.simulation.time_step(), fall = p.simulation.gravity.norm() * h * h;
    const Body* smallest = nullptr;
    int count = 0;
    for (const Body& body : start.world.bodies()) {
      if (!body.has_freedom() || body.kind() != BodyKind::dynamic || !(fall > limit->most * body.size)) continue;
      if (++count == 1 || body.size < smallest->size) smallest = &body;
    }
    if (count < kFewest) return {};
    const double share = fall / smallest->size;
    return {{fmt::format(
                 "'{}' has the size {} and falls {} in a sub-step, {:.2g} of that; with {} stacks of ten hold up to "
                 "{:g}",
                 smallest->name, length_text(smallest->size), length_text(fall), share, limit->response, limit->most),
             "choose response.method = \"constraint_anticipation\", or " +
                 shorter_substeps(p, std::sqrt(share / limit->most))}};
  }
};

}  // namespace

Entry<Warning> long_substep_warning() {
  return entry<Warning, LongSubstep>(
      "long-substep", "bodies fall by a larger part of themselves in a sub-step than stacks of the response take");
}

}  // namespace impinge
