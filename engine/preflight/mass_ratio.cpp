// Heavy on light, and heavy hung on light: what a response takes was measured (tests/README.md, "What a response takes" and
// "Chains").
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/units.hpp"
#include "engine/preflight/hung_masses.hpp"
#include "engine/preflight/shorter_substeps.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

struct Limit {
  std::string_view response;
  double ratio;
};

constexpr Limit kLimits[] = {{"constraint_anticipation", 1e7},
                             {"iterative_constraint_anticipation", 1e7},
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

/// The joints of a chain are pulled straight by what hangs on its links, the faster the lighter and shorter these are:
/// g Δt² m/(m_link lever), up to which chains kept their energy for two swings. Above, pieces of sub-steps hold them
/// (share_of_turns, most_apart, passive_share), and take some of it.
double most_pull(const Parameters& p) { return p.response.method.name() == "soft_constraint" ? 0.005 : 0.025; }

/// What hangs and swings under its load keeps its energy whatever that weighs (step/turns/tension).
bool slows_taut_bodies(const Parameters& p) {
  const auto& method = p.response.method;
  return !method->is_approximate() && !method->lives_on_overlap();
}

/// Two links that hang on one another and carry the most for their masses and levers; one link alone only turns with its
/// load, and holds.
std::vector<Finding> find_hung(const World& world) {
  const Parameters& p = world.parameters;
  const double h = p.simulation.time_step(), fall = p.simulation.gravity.norm() * h * h, most = most_pull(p);
  const std::vector<HungMass> hung = hung_masses(world);
  const auto pull_of = [&](BodyIndex i) {
    const Body& body = world.bodies()[i];
    const HungMass& on = hung[static_cast<std::size_t>(i.value())];
    if (body.kind() != BodyKind::dynamic || !(on.mass > 0.0)) return 0.0;
    return fall * on.mass / (body.mass * (on.lever > 0.0 ? on.lever : body.size));
  };
  double worst = most;
  BodyIndex at, other;
  for (const Attachment& joint : world.attachments()) {
    if (joint.a.body.is_none() || joint.b.body.is_none() || joint.kind != AttachmentKind::point) continue;
    const double a = pull_of(joint.a.body), b = pull_of(joint.b.body);
    if (!(std::min(a, b) > worst)) continue;
    worst = std::min(a, b);
    at = a < b ? joint.a.body : joint.b.body, other = a < b ? joint.b.body : joint.a.body;
  }
  if (at.is_none()) return {};
  const Body& body = world.bodies()[at];
  const double mass = hung[static_cast<std::size_t>(at.value())].mass, ratio = mass / body.mass;
  return {{fmt::format("on '{}', which is joined to '{}' and weighs {}, hang {}, {:.3g} times as much; in sub-steps of "
                       "{} such a chain keeps its energy up to {:.2g} times{}",
                       body.name, world.bodies()[other].name, mass_text(body.mass), mass_text(mass), ratio,
                       time_text(h), ratio * most / worst, slows_taut_bodies(p) ? " where it whips" : ""),
           "take " + shorter_substeps(p, std::sqrt(worst / most)) + ", or masses nearer to each other"}};
}

class MassRatio : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<Finding> found = find_stacked(start);
    for (Finding& hung : find_hung(start.world)) found.push_back(std::move(hung));
    return found;
  }

 private:
  static std::vector<Finding> find_stacked(const SceneAtStart& start) {
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
