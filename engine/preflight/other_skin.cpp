// A new skin round a surface (mend.remesh) whose cells are too wide for the walls.
#include <fmt/format.h>

#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

class OtherSkin : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<Finding> found;
    for (const SurfaceFile& file : start.scene.surfaces)
      if (file.skin_fault)
        found.push_back({fmt::format("{}: {}", file.name, file.skin_fault->what), file.skin_fault->remedy});
    return found;
  }
};

}  // namespace

Entry<Warning> other_skin_warning() {
  return entry<Warning, OtherSkin>("other-skin",
                                   "a new skin has other parts or handles than its surface, or another volume");
}

}  // namespace impinge
