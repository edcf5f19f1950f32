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

/// Whether the boxes of two are in one another by more than half of the smaller one's each way: what only touches mostly is
/// not.
bool share_most(const Body& a, const Body& b) {
  const Aabb of_a = a.bounds(), of_b = b.bounds();
  const Vec3 shared = of_a.max.cwiseMin(of_b.max) - of_a.min.cwiseMax(of_b.min);
  return (shared.array() >= 0.5 * of_a.extent().cwiseMin(of_b.extent()).array()).all();
}

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
    for (const BodyPair& pair : start.world.record().broad_pairs) {
      const Body &a = bodies[pair.a], &b = bodies[pair.b];
      if (pair.a == pair.b || deepest.contains({pair.a, pair.b}) || !share_most(a, b)) continue;
      if (!a.has_freedom() && !b.has_freedom()) continue;
      const double depth = depth_in_one_place(a, b);
      if (depth > kHarmless * pair_size(a, b)) deepest[{pair.a, pair.b}] = depth;
    }
    for (const Enclosure& e : start.enclosures) {  // which body-inside tells
      deepest.erase({e.inner, e.outer});
      deepest.erase({e.outer, e.inner});
    }
    std::vector<std::pair<double, Pair>> pairs;
    pairs.reserve(deepest.size());
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
