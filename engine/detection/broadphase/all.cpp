// The list of broad phases: one line each.
#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {

Entry<BroadPhase> brute_force_broad_phase();
Entry<BroadPhase> sweep_and_prune_broad_phase();

const Registry<BroadPhase>& broad_phases() {
  static const Registry<BroadPhase> list = {sweep_and_prune_broad_phase(), brute_force_broad_phase()};
  return list;
}

}  // namespace impinge
