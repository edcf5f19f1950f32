// The list of warnings: one line each, in the order in which they are told.
#include "engine/preflight/warning.hpp"

namespace impinge {

const Registry<Warning>& warnings() {
  static const Registry<Warning> list = [] {
    Registry<Warning> all;
    IMPINGE_LIST(all, no_body_warning);
    IMPINGE_LIST(all, body_inside_warning);
    IMPINGE_LIST(all, start_overlap_warning);
    IMPINGE_LIST(all, self_crossing_warning);
    IMPINGE_LIST(all, mass_ratio_warning);
    IMPINGE_LIST(all, long_substep_warning);
    IMPINGE_LIST(all, size_ratio_warning);
    IMPINGE_LIST(all, odd_length_warning);
    IMPINGE_LIST(all, far_attachment_warning);
    IMPINGE_LIST(all, coarse_threshold_warning);
    IMPINGE_LIST(all, ignored_restitution_warning);
    IMPINGE_LIST(all, fast_body_warning);
    IMPINGE_LIST(all, sudden_motion_warning);
    IMPINGE_LIST(all, unstable_step_warning);
    IMPINGE_LIST(all, undamped_newmark_warning);
    IMPINGE_LIST(all, own_weight_warning);
    IMPINGE_LIST(all, triangle_sizes_warning);
    IMPINGE_LIST(all, thin_tetrahedra_warning);
    IMPINGE_LIST(all, other_skin_warning);
    IMPINGE_LIST(all, default_density_warning);
    IMPINGE_LIST(all, slow_frame_warning);
    IMPINGE_LIST(all, much_memory_warning);
    IMPINGE_LIST(all, no_answer_warning);
    return all;
  }();
  return list;
}

}  // namespace impinge
