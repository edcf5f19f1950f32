// Lengths and speeds that a scene sets in metres, against the smallest body that they hold for: what suits a scene of
// metres is blind, or sees everything, in one of millimetres.
#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/scale.hpp"
#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMostLength = 0.1;   // of a body's size; auto is 0.0024
constexpr double kMostTimes = 100.0;  // of what auto would be

class CoarseThreshold : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Parameters& p = start.world.parameters;
    const Body *thinnest = nullptr, *smallest = nullptr;  // of all; of those that move freely
    const auto is_smaller = [](const Body& body, const Body* than) {
      return than == nullptr || body.size < than->size;
    };
    for (const Body& body : start.world.bodies()) {
      if (is_smaller(body, thinnest)) thinnest = &body;
      if (body.has_freedom() && is_smaller(body, smallest)) smallest = &body;
    }
    if (smallest == nullptr) return {};
    std::vector<Finding> found;
    if (const auto given = p.contact.activation_distance.given; given && *given > kMostLength * thinnest->size)
      found.push_back({fmt::format("contact.activation_distance is {}, {:.3g} % of '{}', which has the size {}",
                                   length_text(*given), 100.0 * *given / thinnest->size, thinnest->name,
                                   length_text(thinnest->size)),
                       advice(p.contact.activation_distance.part * thinnest->size, "m")});
    for (const Body& body : start.world.bodies())
      if (const auto own = body.self_exempt_distance; own && *own > kMostLength * body.size)
        found.push_back({fmt::format("body.{}.self_exempt_distance is {}, {:.3g} % of the body, which has the size {}",
                                     body.name, length_text(*own), 100.0 * *own / body.size, length_text(body.size)),
                         "it keeps whole limbs from meeting: take a smaller one"});
    const double speed = speed_scale(scale_gravity(p.simulation.gravity), smallest->size);
    const std::pair<const char*, const Threshold*> speeds[] = {
        {"contact.restitution_threshold", &p.contact.restitution_threshold},
        {"contact.max_push_out", &p.contact.max_push_out},
        {"simulation.sleep_speed", &p.simulation.sleep_speed}};
    for (const auto& [path, threshold] : speeds) {
      const double automatic = threshold->part * speed;
      if (!threshold->given || !(*threshold->given > kMostTimes * automatic)) continue;
      found.push_back(
          {fmt::format("{} is {:.3g} m/s, {:.3g} times what suits '{}', which has the size {}", path, *threshold->given,
                       *threshold->given / automatic, smallest->name, length_text(smallest->size)),
           advice(automatic, "m/s")});
    }
    return found;
  }

 private:
  static std::string advice(double automatic, const char* unit) {
    return fmt::format("leave it out or write \"auto\", which is {:.2g} {} here", automatic, unit);
  }
};

}  // namespace

Entry<Warning> coarse_threshold_warning() {
  return entry<Warning, CoarseThreshold>("coarse-threshold",
                                         "a length or speed that the scene sets is too large for its smallest body");
}

}  // namespace impinge
