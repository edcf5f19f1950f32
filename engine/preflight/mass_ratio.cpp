// Heavy on light: what a response takes was measured (tests/README.md, "What a response takes").
#include <fmt/format.h>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

struct Limit {
  std::string_view response;
  double ratio;
};

constexpr Limit kLimits[] = {{"constraint_anticipation", 3e5},
                             {"iterative_constraint_anticipation", 3e5},
                             {"sequential_impulse", 100.0},
                             {"simultaneous_impulse", 100.0},
                             {"quick", 100.0},
                             {"penalty", 30.0},
                             {"soft_constraint", 10.0}};
constexpr double kOfOthers = 100.0;

double most_ratio(const Parameters& p) {
  for (const Limit& limit : kLimits)
    if (limit.response == p.response.method.name()) return limit.ratio;
  return kOfOthers;
}

class MassRatio : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Body *lightest = nullptr, *heaviest = nullptr;
    for (const Body& body : start.world.bodies()) {
      if (!body.has_freedom()) continue;
      if (lightest == nullptr || body.mass < lightest->mass) lightest = &body;
      if (heaviest == nullptr || body.mass > heaviest->mass) heaviest = &body;
    }
    if (heaviest == nullptr) return {};
    const Parameters& p = start.world.parameters;
    const double ratio = heaviest->mass / lightest->mass, most = most_ratio(p);
    if (!(ratio > most)) return {};
    return {{fmt::format("'{}' weighs {}, {:.3g} times as much as '{}' ({}); with {} heavy things on light ones are "
                         "carried up to about {:g} times",
                         heaviest->name, mass_text(heaviest->mass), ratio, lightest->name, mass_text(lightest->mass),
                         p.response.method.name(), most),
             most < 1e4 ? "take response.method = \"constraint_anticipation\", or masses nearer to each other"
                        : "take masses nearer to each other, or more simulation.substeps"}};
  }
};

}  // namespace

Entry<Warning> mass_ratio_warning() {
  return entry<Warning, MassRatio>("mass-ratio", "a body weighs more times another than the response carries");
}

}  // namespace impinge
