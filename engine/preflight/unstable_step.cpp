// Sub-steps longer than explicit schemes stand: of deformable bodies, and of springs of a given stiffness at contacts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/units.hpp"
#include "engine/preflight/highest_frequency.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

/// Symplectic Euler with damping at the start: x'' = −ω² x − c x' is stable for h² ω² + 2 h c < 4, and c grows with ω.
double stable_step(const DeformableBody& body, double omega) {
  const double c = body.damping.alpha + body.damping.beta * omega * omega;
  return (std::sqrt(c * c + 4.0 * omega * omega) - c) / (omega * omega);
}

std::string substeps_for(const Parameters& p, double step) {
  return fmt::format("simulation.substeps = {:.0f}", std::ceil(p.simulation.frame_time / (0.9 * step)));
}

class UnstableStep : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<Finding> found;
    look_at_elements(start, found);
    look_at_springs(start, found);
    return found;
  }

 private:
  static void look_at_elements(const SceneAtStart& start, std::vector<Finding>& found) {
    const Parameters& p = start.world.parameters;
    if (!p.simulation.integrator->is_explicit()) return;
    const double h = p.simulation.time_step();
    for (const Body& body : start.world.bodies()) {
      const auto* soft = body.as<DeformableBody>();
      const double omega = soft == nullptr ? 0.0 : highest_frequency(*soft);
      if (!(omega > 0.0)) continue;
      const double most = stable_step(*soft, omega);
      if (h <= most) continue;
      found.push_back({fmt::format("{} is stable for '{}' up to sub-steps of {}, and these are of {}",
                                   p.simulation.integrator.name(), body.name, time_text(most), time_text(h)),
                       fmt::format("{}, or an implicit simulation.integrator", substeps_for(p, most))});
    }
  }

  static void look_at_springs(const SceneAtStart& start, std::vector<Finding>& found) {
    const Parameters& p = start.world.parameters;
    if (p.response.method.name() != "penalty") return;
    const auto value = [&](const char* name) {
      return start.rows.find(std::string("response.penalty.") + name)->get();
    };
    const double k = std::get<double>(value("stiffness")), b = std::get<double>(value("damping"));
    if (std::get<std::string>(value("form")) != "explicit" || !(k > 0.0)) return;
    const double h = p.simulation.time_step();
    for (const Body& body : start.world.bodies()) {
      if (body.kind() != BodyKind::dynamic) continue;
      // the same law for the body as a point: no contact of it feels more mass
      const double c = b / body.mass, square = k / body.mass, most = (std::sqrt(c * c + 4.0 * square) - c) / square;
      if (h <= most) continue;
      found.push_back(
          {fmt::format("a spring of {:g} N/m is stable under '{}' ({}) up to sub-steps of {}, and these are "
                       "of {}",
                       k, body.name, mass_text(body.mass), time_text(most), time_text(h)),
           fmt::format("response.penalty.stiffness = 0 chooses one by mass and sub-step, or {}",
                       substeps_for(p, most))});
    }
  }
};

}  // namespace

Entry<Warning> unstable_step_warning() {
  return entry<Warning, UnstableStep>("unstable-step", "an explicit scheme is not stable at this sub-step");
}

}  // namespace impinge
