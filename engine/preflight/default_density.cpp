// A body that moves freely and says neither what it weighs nor how dense it is.
#include <fmt/format.h>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostAlone = 4;  // bodies that have a line each

/// Whether the table of a body leaves its mass to the default. A volume's file may hold a density of its own.
bool leaves_it_out(const TomlNode& table) {
  if (table.find("mass") != nullptr) return false;
  const TomlEntry *material = table.find("material"), *volume = table.find("volume");
  if (material != nullptr && material->value.find("density") != nullptr) return false;
  return volume == nullptr || volume->value.kind != TomlNode::text || !volume->value.string.ends_with(".veg");
}

class DefaultDensity : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Bodies& bodies = start.world.bodies();
    std::vector<const Body*> light;
    for (const TomlNode& table : start.scene.bodies) {
      const TomlEntry* name = table.find("name");
      const BodyIndex at = name == nullptr ? BodyIndex() : bodies.find(name->value.string);
      if (at.is_none() || !bodies[at].has_freedom() || !leaves_it_out(table)) continue;
      light.push_back(&bodies[at]);
    }
    const std::string remedy = "add material = { density = ... } or mass = ...";
    if (light.size() > kMostAlone) {  // copies, most likely
      double sum = 0.0;
      for (const Body* body : light) sum += body->mass;
      return {{fmt::format(
                   "{} bodies, '{}' to '{}', name neither mass nor density: 1000 kg/m³ makes them weigh {} together",
                   light.size(), light.front()->name, light.back()->name, mass_text(sum)),
               remedy}};
    }
    std::vector<Finding> found;
    for (const Body* body : light)
      found.push_back({fmt::format("'{}' names neither mass nor density: 1000 kg/m³ makes it weigh {}", body->name,
                                   mass_text(body->mass)),
                       remedy});
    return found;
  }
};

}  // namespace

Entry<Warning> default_density_warning() {
  return entry<Warning, DefaultDensity>("default-density", "a body that moves freely takes the density of water");
}

}  // namespace impinge
