// Bodies that move farther in a sub-step than others are thick, where nobody looks back at motions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/scripted_body.hpp"
#include "engine/core/units.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/preflight/shorter_substeps.hpp"
#include "engine/preflight/warning.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr double kSafe = 0.5;      // of a thickness: from there on contacts still know the way out
constexpr int kMostLooks = 10000;  // at a motion

/// How far a point of it goes in a sub-step at most, metres: as it starts, or anywhere on its way if it is driven.
double way_of(const Body& body, double h) {
  const auto* scripted = body.as<ScriptedBody>();
  if (scripted == nullptr || scripted->motion.keys().size() < 2) return h * body.fastest_point();
  const double begin = scripted->motion.keys().front().time, end = scripted->motion.keys().back().time;
  const int looks = static_cast<int>(std::clamp((end - begin) / h, 1.0, static_cast<double>(kMostLooks)));
  double most = 0.0;
  for (int i = 0; i < looks; ++i) {
    const double time = begin + (end - begin) * i / looks;
    const Pose now = scripted->motion.at(time), then = scripted->motion.at(time + h);
    const double angle = rotation_log(then.rotation * now.rotation.transpose()).norm();
    most = std::max(most, (then.apply(body.center) - now.apply(body.center)).norm() + angle * body.radius);
  }
  return most;
}

std::string remedy(const Parameters& p, double times) {
  const std::string shorter = shorter_substeps(p, times);
  if (watching(p) == Continuous::off) return "set narrow_phase.continuous = \"auto\", or " + shorter;
  return "choose a response.method that lets nothing overlap, or " + shorter;
}

class FastBody : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Parameters& p = start.world.parameters;
    if (watching(p) != Continuous::off && !p.response.method->lives_on_overlap()) return {};
    const Bodies& bodies = start.world.bodies();
    std::vector<double> thickness;
    thickness.reserve(static_cast<std::size_t>(bodies.size().value()));
    for (const Body& body : bodies) thickness.push_back(body.shape->thickness());
    std::vector<std::pair<double, Finding>> all;
    for (BodyIndex a(0); a < bodies.size(); ++a) {
      const double way = way_of(bodies[a], p.simulation.time_step());
      if (!(way > 0.0) || bodies[a].absent) continue;
      BodyIndex thinnest;
      for (BodyIndex b(0); b < bodies.size(); ++b) {
        // what is through a plane is inside it still
        if (a == b || bodies[b].shape->as<Plane>() != nullptr || bodies.never_touch(a, b)) continue;
        if (!bodies[a].has_freedom() && !bodies[b].has_freedom()) continue;
        const auto of = [&](BodyIndex i) { return thickness[static_cast<std::size_t>(i.value())]; };
        if (thinnest.is_none() || of(b) < of(thinnest)) thinnest = b;
      }
      if (thinnest.is_none()) continue;
      const double thin = std::min(thickness[static_cast<std::size_t>(a.value())],
                                   thickness[static_cast<std::size_t>(thinnest.value())]);
      if (!(way > kSafe * thin)) continue;
      all.push_back(
          {way / thin,
           {fmt::format("'{}' moves {} in a sub-step, and '{}' or itself is {} thick: {} are safe", bodies[a].name,
                        length_text(way), bodies[thinnest].name, length_text(thin), length_text(kSafe * thin)),
            remedy(p, way / (kSafe * thin))}});
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& l, const auto& r) { return l.first > r.first; });
    std::vector<Finding> found;
    for (auto& [share, finding] : all) found.push_back(std::move(finding));
    return found;
  }
};

}  // namespace

Entry<Warning> fast_body_warning() {
  return entry<Warning, FastBody>("fast-body",
                                  "a body may pass another in a sub-step, and nobody looks back at motions");
}

}  // namespace impinge
