// Deformable bodies that their own weight flattens.
#include <fmt/format.h>

#include "engine/bodies/deformable_body.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMostStrain = 0.5;  // strain at the foot of a column of the body's height

class OwnWeight : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Vec3& gravity = start.world.parameters.simulation.gravity;
    if (gravity.isZero(0.0)) return {};
    std::vector<Finding> found;
    for (const Body& body : start.world.bodies()) {
      const auto* soft = body.as<DeformableBody>();
      if (soft == nullptr) continue;
      double low = INFINITY, high = -INFINITY, volume = 0.0;
      for (const Vec3& x : body.world_vertices) {
        const double height = -x.dot(gravity.normalized());
        low = std::min(low, height), high = std::max(high, height);
      }
      for (const TetRest& element : soft->fem.elements()) volume += element.volume;
      const double young = soft->material->settings().young;
      const double strain = body.mass / volume * gravity.norm() * (high - low) / young;
      if (!(strain > kMostStrain)) continue;
      found.push_back(
          {fmt::format("'{}' would be pressed by its own weight, {:.3g} Pa at its foot, to a strain of "
                       "{:.3g} (material.young is {:.3g} Pa)",
                       body.name, strain * young, strain, young),
           fmt::format("young = {:.1g} or more keeps its form, or check size and density", strain * young / 0.1)});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> own_weight_warning() {
  return entry<Warning, OwnWeight>("own-weight", "a deformable body is too soft for its own weight");
}

}  // namespace impinge
