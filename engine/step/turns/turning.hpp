// What velocities leave out of a sub-step: that bodies turn. J v is the speed of a contact where the sub-step begins. A
// point on the outside of a body rises a little on its way round, so that bodies which rest on each other never notice;
// inside a hook, a hole or a link it comes down, towards its own centre of mass, in every sub-step.
// What rolls or stands on its tip is turned by its impulses where the sub-step begins, and its contact goes on turning while
// the velocities last. Its rows measure the velocity half way and push where it begins, between the velocities of two
// halves, so that neither its path nor its energy is lost to first order (as SHAKE has it of what is held
// [HairerLubichWanner06 VII.1]); and round bodies touch with another place of theirs then, where the rim of a coin comes
// down and its own points rise.
#pragma once

#include "engine/step/turns/end_rows.hpp"

namespace impinge {

/// Whether any body turns so far that its contacts could notice, at the free velocities.
bool is_turning(const Bodies& bodies, const AssembledGroup& group, const ContactSettings& settings, double time_step);

/// How much deeper than it began the worst contact ends, or of round bodies how far the rows were told wrongly of it,
/// metres; 0: none by more than what push-out takes for nothing.
double most_lost(const GroupSystem& system, const EndRows& ends, const ContactSettings& settings, double time_step);

/// Whether a contact ends deeper than it began by more than positions may take back.
bool ends_deep(const GroupSystem& system, const EndRows& ends, const ContactSettings& settings);

/// What the group's impulses give to its motion, and the kinetic energy of its rigid bodies at their free velocities, J.
/// Contact takes energy, or none: a straight way that cuts an arc short is as quick as the arc where bodies hang in one
/// another, and what asks for more is an impact, which has no arc to follow.
std::pair<double, double> energy_won(const Bodies& bodies, const AssembledGroup& group);

/// Raises the rows' bounds, `bounds` before anybody asked, by what turning takes of the gaps that J v says, and tells them
/// what rolls. Whether that is more of any than what push-out takes for nothing.
bool ask_for_turning(GroupSystem& system, const EndRows& ends, std::span<const double> bounds,
                     const ContactSettings& settings, double time_step);

/// Asks no contact to open faster than it closes, which wins no energy, and leaves the rest to positions. False: that is
/// nothing, or too much.
bool limit_turning(GroupSystem& system, std::span<const double> bounds, const ContactSettings& settings,
                   double time_step);

/// Takes that back.
void forget_turning(GroupSystem& system, std::span<const double> bounds);

}  // namespace impinge
