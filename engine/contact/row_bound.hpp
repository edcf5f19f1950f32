// What the normal row of a contact asks of the velocity at the end of a sub-step.
#pragma once

#include "engine/contact/contact_scale.hpp"
#include "engine/contact/contact_settings.hpp"

namespace impinge {

/// One contact along its normal.
struct NormalMotion {
  double gap = 0.0;            ///< g0, metres
  double free_velocity = 0.0;  ///< J v*, m/s
  double velocity_before = 0.0;
  double restitution = 0.0;  ///< e of the pair
  double after = 0.0;        ///< what forces add to a rebound until the time that velocities are those of, m/s
  double speed_scale = ContactScale().speed;  ///< of the pair, m/s: what automatic thresholds are parts of
};

/// J v >= -g0/Δt, raised to the rebound -e·min(0, J v⁻) where the gap closes in this sub-step; for overlap that exists
/// already 0 (push_out = "split"), or the capped recovery speed (push_out = "velocity"). [Haapaoja16 §4.1]
double row_bound(const NormalMotion& contact, const ContactSettings& settings, double time_step);

}  // namespace impinge
