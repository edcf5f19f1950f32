// The list of broad phases: one line each. The first is the default.
#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {

const Registry<BroadPhase>& broad_phases() {
  static const Registry<BroadPhase> list = [] {
    Registry<BroadPhase> all;
    IMPINGE_LIST(all, sweep_and_prune_broad_phase);
    IMPINGE_LIST(all, bvh_broad_phase);
    IMPINGE_LIST(all, brute_force_broad_phase);
    return all;
  }();
  return list;
}

}  // namespace impinge
