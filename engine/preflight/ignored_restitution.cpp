// A restitution that is set and that the response has no use for: bodies would be expected to bounce.
#include <fmt/format.h>

#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

class IgnoredRestitution : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    const Parameters& p = start.world.parameters;
    if (p.response.method->uses_restitution()) return {};
    const Body* most = nullptr;
    const auto of = [&](const Body& body) { return body.restitution.value_or(p.contact.restitution); };
    for (const Body& body : start.world.bodies())
      if (!body.deleted && of(body) > (most == nullptr ? 0.0 : of(*most))) most = &body;
    if (most == nullptr) return {};
    return {
        {fmt::format("'{}' has a restitution of {:g}, which {} does not use: bodies give back what its dampers leave",
                     most->name, of(*most), p.response.method.name()),
         "choose another response.method where bodies should bounce"}};
  }
};

}  // namespace

Entry<Warning> ignored_restitution_warning() {
  return entry<Warning, IgnoredRestitution>("ignored-restitution",
                                            "a restitution is set, and the response does not use it");
}

}  // namespace impinge
