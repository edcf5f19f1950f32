// Bodies of files that don't say their unit, of a length that nobody's assets have.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/core/units.hpp"
#include "engine/io/meshes/mesh_unit.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

/// Whether only the file could say what its numbers are in, and doesn't.
bool is_unit_open(const Scene& scene, const TomlNode& table) {
  const TomlEntry* surface = table.find("surface");
  if (surface == nullptr || table.find("unit") != nullptr || table.find("scale") != nullptr) return false;
  const auto has_its_name = [&](const SurfaceFile& file) { return file.name == surface->value.string; };
  const auto file = std::find_if(scene.surfaces.begin(), scene.surfaces.end(), has_its_name);
  return file != scene.surfaces.end() && !file->says_unit;
}

class OddLength : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Bodies& bodies = start.world.bodies();
    std::vector<Finding> found;
    std::set<std::string> seen;  // one question a file
    for (const TomlNode& table : start.scene.bodies) {
      const TomlEntry* name = table.find("name");
      const BodyIndex at = name == nullptr ? BodyIndex() : bodies.find(name->value.string);
      if (at.is_none() || bodies[at].shape->mesh() == nullptr || !is_unit_open(start.scene, table)) continue;
      const Body& body = bodies[at];
      const double longest = body.shape->bounds({}).extent().maxCoeff();
      // a ground may be as long as it likes
      const std::string question = body.has_freedom() || longest < 1.0 ? unit_question(longest) : "";
      if (question.empty() || !seen.insert(body.surface_file).second) continue;
      const std::string weight = body.has_freedom() ? fmt::format(" and weighs {}", mass_text(body.mass)) : "";
      found.push_back({fmt::format("'{}' is {} long{}, for {} doesn't say its unit and is taken for metres", body.name,
                                   length_text(longest), weight, body.surface_file),
                       question + ", or scale = 1 if it is right"});
    }
    return found;
  }
};

}  // namespace

Entry<Warning> odd_length_warning() {
  return entry<Warning, OddLength>("odd-length", "a file that doesn't say its unit makes a body of an odd length");
}

}  // namespace impinge
