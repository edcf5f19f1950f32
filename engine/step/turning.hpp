// What velocities leave out of a sub-step: that bodies turn. J v is the speed of a contact where the sub-step begins. A
// point on the outside of a body rises a little on its way round, so that bodies which rest on each other never notice;
// inside a hook, a hole or a link it comes down, towards its own centre of mass, in every sub-step.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

/// By contact of a group: its gap where the sub-step will end with the group's Δv, metres; prescribed bodies end where
/// their velocity takes them, nodes go straight. Infinite of attachments, of what nothing rigid takes part in, and where a
/// body turns so far that one straight step can't mean it.
std::vector<double> end_gaps(const Bodies& bodies, const AssembledGroup& group, const ContactList& contacts,
                             double time_step);

/// How much deeper than it began the worst contact ends, metres; 0: none by more than what push-out takes for nothing.
double most_lost(const GroupSystem& system, std::span<const double> end_gaps, const ContactSettings& settings);

/// What the group's impulses give to its motion, and the kinetic energy of its rigid bodies at their free velocities, J.
/// Contact takes energy, or none: a straight way that cuts an arc short is as quick as the arc where bodies hang in one
/// another, and what asks for more is an impact, which has no arc to follow.
std::pair<double, double> energy_won(const Bodies& bodies, const AssembledGroup& group);

/// Raises the rows' bounds, `bounds` before anybody asked, by what turning takes of the gaps that J v says. Whether that is
/// more of any than what push-out takes for nothing.
bool ask_for_turning(GroupSystem& system, std::span<const double> end_gaps, std::span<const double> bounds,
                     const ContactSettings& settings, double time_step);

}  // namespace impinge
