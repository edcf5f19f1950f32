// Scripted bodies that jump: between two keys, within a few frames, far faster than anywhere else on their way. Most often a
// key's time is wrong by a digit; what they hit is thrown.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/scripted_body.hpp"
#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kTimes = 10.0;   // as fast as on the next fastest part of its way
constexpr double kFrames = 4.0;   // within which it is over
constexpr double kOfSize = 0.05;  // of the body, that it goes at least

struct Part {
  std::size_t key = 0;  ///< that it begins with
  double way = 0.0, time = 0.0;
  double speed() const { return way / time; }
};

/// Ways of the file's origin, and of a point half the body's size from it as it turns.
double way_between(const MotionKey& from, const MotionKey& to, double reach) {
  return (to.position - from.position).norm() + reach * M_PI / 180.0 * (to.rotation - from.rotation).norm();
}

class SuddenMotion : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const double frame = start.world.parameters.simulation.frame_time;
    std::vector<Finding> found;
    for (const Body& body : start.world.bodies()) {
      const auto* scripted = body.as<ScriptedBody>();
      if (scripted == nullptr || scripted->motion.keys().size() < 3) continue;
      const std::vector<MotionKey>& keys = scripted->motion.keys();
      std::vector<Part> parts;
      for (std::size_t k = 0; k + 1 < keys.size(); ++k)
        parts.push_back({k, way_between(keys[k], keys[k + 1], body.radius), keys[k + 1].time - keys[k].time});
      std::sort(parts.begin(), parts.end(), [](const Part& l, const Part& r) { return l.speed() > r.speed(); });
      const Part& fastest = parts.front();
      if (!(parts[1].speed() > 0.0) || fastest.speed() < kTimes * parts[1].speed() || fastest.time > kFrames * frame ||
          fastest.way < kOfSize * 2.0 * body.radius)
        continue;
      found.push_back(
          {fmt::format("motion of '{}' goes {} in {} between its keys {} and {} (from {} on), at {:.3g} m/s, {:.0f} "
                       "times as fast as anywhere else",
                       body.name, length_text(fastest.way), time_text(fastest.time), fastest.key + 1, fastest.key + 2,
                       time_text(keys[fastest.key].time), fastest.speed(), fastest.speed() / parts[1].speed()),
           "look at those keys' times"});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> sudden_motion_warning() {
  return entry<Warning, SuddenMotion>("sudden-motion", "a scripted body jumps between two of its keys");
}

}  // namespace impinge
