// Solves of the sub-step that was tried which ended without an answer, or a scene that does not survive it.
#include <fmt/format.h>

#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

class NoAnswer : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    if (start.trial == nullptr) return {};
    if (!start.trial->diverged.empty())
      return {{"the sub-step that was tried diverged: " + start.trial->diverged,
               "look at the other warnings, or take more simulation.substeps"}};
    const FrameStats& stats = start.trial->stats;
    if (stats.unconverged == 0) return {};
    std::string limit;
    for (const UnsolvedGroups& cause : stats.unsolved)
      if (cause.reason == SolveEnd::cap) limit = cause.limit;
    return {{fmt::format("{} of {} group solves ended without an answer, the largest residual is {:.2g} m/s",
                         stats.unconverged, stats.groups, stats.residual),
             limit.empty() ? "take more simulation.substeps, or another response.method"
                           : fmt::format("they stopped at {}: raise it, or take another response.method", limit)}};
  }
};

}  // namespace

Entry<Warning> no_answer_warning() {
  return entry<Warning, NoAnswer>("no-answer", "with --trial: contacts of the first sub-step are not solved");
}

}  // namespace impinge
