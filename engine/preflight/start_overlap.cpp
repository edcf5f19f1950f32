// Pairs whose surfaces overlap at the start: they are pushed apart, with whatever stands in the way.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/contact/pair_scale.hpp"
#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

/// Of the smaller body's size. A quarter of the automatic activation distance, which recovery takes back unnoticed.
constexpr double kHarmless = 6e-4;

class StartOverlap : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Bodies& bodies = start.world.bodies();
    using Pair = std::pair<BodyIndex, BodyIndex>;
    std::map<Pair, double> deepest;
    for (const ContactRecord& c : start.world.record().contacts) {
      if (c.body_a == c.body_b || -c.gap <= kHarmless * pair_size(bodies[c.body_a], bodies[c.body_b])) continue;
      double& depth = deepest[{c.body_a, c.body_b}];
      depth = std::max(depth, -c.gap);
    }
    for (const Enclosure& e : start.enclosures) {  // which body-inside tells
      deepest.erase({e.inner, e.outer});
      deepest.erase({e.outer, e.inner});
    }
    std::vector<std::pair<double, Pair>> pairs;
    for (const auto& [pair, depth] : deepest) pairs.emplace_back(depth, pair);
    std::stable_sort(pairs.begin(), pairs.end(), [](const auto& l, const auto& r) { return l.first > r.first; });
    std::vector<Finding> found;
    for (const auto& [depth, pair] : pairs) {
      const Body &a = bodies[pair.first], &b = bodies[pair.second];
      found.push_back({fmt::format("'{}' and '{}' start {} in one another, {:.2g} % of the smaller one's size", a.name,
                                   b.name, length_text(depth), 100.0 * depth / pair_size(a, b)),
                       "move them apart; they are pushed apart as response and push-out allow"});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> start_overlap_warning() {
  return entry<Warning, StartOverlap>("start-overlap", "two bodies overlap at the start");
}

}  // namespace impinge
