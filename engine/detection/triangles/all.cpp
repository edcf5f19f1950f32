// The list of narrow phases between meshes: one line each. The first is the default.
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

const Registry<NarrowPhase>& narrow_phases() {
  static const Registry<NarrowPhase> list = [] {
    Registry<NarrowPhase> all;
    IMPINGE_LIST(all, bvh_narrow_phase);
    IMPINGE_LIST(all, spatial_hash_narrow_phase);
#ifdef IMPINGE_OPENVDB
    IMPINGE_LIST(all, distance_field_narrow_phase);
#endif
    IMPINGE_LIST(all, continuous_narrow_phase);
    IMPINGE_LIST(all, brute_force_narrow_phase);
    return all;
  }();
  return list;
}

}  // namespace impinge
