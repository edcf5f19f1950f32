// A scene in which nothing is.
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

class NoBody : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    if (!start.world.bodies().is_empty()) return {};
    return {{"the scene has no body, so nothing moves and pictures are empty",
             "add [[body]] tables, with name, kind and shape or surface"}};
  }
};

}  // namespace

Entry<Warning> no_body_warning() { return entry<Warning, NoBody>("no-body", "the scene has no body"); }

}  // namespace impinge
