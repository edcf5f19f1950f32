#include "engine/world/step_record.hpp"

namespace impinge {

std::string_view name_of(SolveEnd end) {
  constexpr std::string_view kNames[] = {"converged", "cap", "stalled", "contradiction", "refused", "fixed"};
  return kNames[static_cast<int>(end)];
}

void count_unsolved(std::vector<UnsolvedGroups>& all, const UnsolvedGroups& more) {
  for (UnsolvedGroups& known : all)
    if (known.reason == more.reason && known.limit == more.limit) {
      known.solves += more.solves;
      return;
    }
  all.push_back(more);
}

void FrameStats::take_unsolved(const UnsolvedGroups& cause, double residual) {
  if (unconverged == 0 || residual > unsolved_residual) {
    ended = cause.reason;
    unsolved_residual = residual;
  }
  ++unconverged;
  count_unsolved(unsolved, cause);
}

void FrameStats::take(std::span<const BodyShare> shares) {
  bodies = dofs = asleep = 0, self_crossings = 0;
  Balance sum;
  for (const BodyShare& share : shares) {
    bodies += share.bodies, dofs += share.dofs, asleep += share.asleep;
    self_crossings += share.self_crossings;
    sum += share.balance;
  }
  take(sum);
}

}  // namespace impinge
