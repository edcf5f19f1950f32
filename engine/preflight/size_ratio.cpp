// Bodies that move freely and differ in size by so much that one of their files has another unit. Contacts would hold them
// (tests/README.md, "What a response takes").
#include <fmt/format.h>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMostRatio = 100.0;  // centimetres taken for metres

class SizeRatio : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Body *smallest = nullptr, *largest = nullptr;
    for (const Body& body : start.world.bodies()) {
      if (!body.has_freedom()) continue;
      if (smallest == nullptr || body.size < smallest->size) smallest = &body;
      if (largest == nullptr || body.size > largest->size) largest = &body;
    }
    if (largest == nullptr || !(largest->size > kMostRatio * smallest->size)) return {};
    return {
        {fmt::format("'{}' has the size {}, {:.3g} times that of '{}' ({})", largest->name, length_text(largest->size),
                     largest->size / smallest->size, smallest->name, length_text(smallest->size)),
         "contacts hold that, but beyond a hundred it is a unit or a scale as a rule: look at both"}};
  }
};

}  // namespace

Entry<Warning> size_ratio_warning() {
  return entry<Warning, SizeRatio>("size-ratio",
                                   "a body is over a hundred times as large as another, as if a file had another unit");
}

}  // namespace impinge
