// A scene that fits into the memory that may be used, and leaves little for what comes.
#include <fmt/format.h>

#include "engine/core/memory.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMuch = 0.8;  // of the limit

class MuchMemory : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const double limit = static_cast<double>(memory_limit());
    if (start.trial == nullptr || start.trial->bytes < kMuch * limit) return {};
    return {{fmt::format("{} are in use after a sub-step, {:.0f} % of the {} that may be",
                         describe_bytes(start.trial->bytes), 100.0 * start.trial->bytes / limit, describe_bytes(limit)),
             "take coarser surfaces or volumes, or raise --memory-limit"}};
  }
};

}  // namespace

Entry<Warning> much_memory_warning() {
  return entry<Warning, MuchMemory>("much-memory",
                                    "with --trial: a sub-step takes most of the memory that may be used");
}

}  // namespace impinge
