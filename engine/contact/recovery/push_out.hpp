// Recovery from overlap that exists already, on positions only: so pushing out makes no energy.
#pragma once

#include <span>

#include "engine/contact/contact_settings.hpp"
#include "engine/contact/group_system.hpp"

namespace impinge {

/// Whether any contact of the group overlaps, or will after the sub-step, enough to be pushed out, or an attachment has
/// drifted so far. `drift`: by row, metres, as AssembledGroup has it.
bool needs_push_out(const GroupSystem& solved, std::span<const Vec3> drift, const ContactSettings& settings,
                    double time_step);

/// The same group as a frictionless problem on pseudo-velocities from rest, solved after the velocities: overlapping
/// contacts separate by their overlap (at most max_push_out), attachments take back their drift, the others may approach by
/// no more than what is left of their gap. Only positions follow from it.
GroupSystem make_push_out_system(const GroupSystem& solved, std::span<const Vec3> drift,
                                 const ContactSettings& settings, double time_step);

}  // namespace impinge
