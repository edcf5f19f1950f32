// Newmark, and the energy-momentum scheme that is one in contact, without damping where waves cross a soft body within a
// few sub-steps: what is stopped at its surface goes on by the accelerations that the scheme remembers, and contact makes
// energy. It was measured (tests/README.md, "Newmark in contact").
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine/bodies/deformable_body.hpp"
#include "engine/core/units.hpp"
#include "engine/preflight/shorter_substeps.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMostCrossings = 0.2;  // of a body in a sub-step, by waves of √(E/ρ)

double wave_speed(const DeformableBody& body) {
  double volume = 0.0, young = 0.0;
  for (std::size_t i = 0; i < body.fem.elements().size(); ++i) {
    volume += body.fem.elements()[i].volume;
    young = std::max(young, body.fem.material(static_cast<int>(i)).settings().young);
  }
  return std::sqrt(young * volume / body.mass);
}

class UndampedNewmark : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Parameters& p = start.world.parameters;
    const std::string_view name = p.simulation.integrator.name();
    if (name != "newmark" && name != "energy_momentum") return {};
    const double h = p.simulation.time_step(), enough = kEnoughDamping * h;
    struct Found {
      double crossings;
      const DeformableBody* body;
    };
    std::vector<Found> found;
    for (const Body& body : start.world.bodies()) {
      const auto* soft = body.as<DeformableBody>();
      if (soft == nullptr || soft->damping.beta >= enough) continue;
      const double crossings = wave_speed(*soft) * h / soft->size;
      if (crossings > kMostCrossings) found.push_back({crossings, soft});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& l, const Found& r) { return l.crossings > r.crossings; });
    std::vector<Finding> findings;
    for (const auto& [crossings, body] : found)
      findings.push_back(
          {fmt::format("waves cross '{}', {} thick, {:.3g} times in a sub-step of {}; from {:g} on {} makes energy "
                       "in contact unless damping holds it down",
                       body->name, length_text(body->size), crossings, time_text(h), kMostCrossings, name),
           "take " + enough_damping(p) + " or more, a quarter of a sub-step, or another simulation.integrator"});
    return findings;
  }
};

}  // namespace

Entry<Warning> undamped_newmark_warning() {
  return entry<Warning, UndampedNewmark>("undamped-newmark",
                                         "newmark or energy_momentum without damping makes energy in contact");
}

}  // namespace impinge
