// The list of narrow phases between meshes: one line each. The first is the default.
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

Entry<NarrowPhase> brute_force_narrow_phase();
Entry<NarrowPhase> spatial_hash_narrow_phase();

const Registry<NarrowPhase>& narrow_phases() {
  static const Registry<NarrowPhase> list = {spatial_hash_narrow_phase(), brute_force_narrow_phase()};
  return list;
}

}  // namespace impinge
