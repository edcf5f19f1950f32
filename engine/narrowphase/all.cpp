// The list of narrow phases between meshes: one line each.
#include "engine/narrowphase/narrow_phase.hpp"

namespace impinge {

Entry<NarrowPhase> brute_force_narrow_phase();

const Registry<NarrowPhase>& narrow_phases() {
  static const Registry<NarrowPhase> list = {brute_force_narrow_phase()};
  return list;
}

}  // namespace impinge
