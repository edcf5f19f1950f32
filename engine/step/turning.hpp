// What velocities leave out of a sub-step: that bodies turn. J v is the speed of a contact where the sub-step begins. A
// point on the outside of a body rises a little on its way round, so that bodies which rest on each other never notice;
// inside a hook, a hole or a link it comes down, towards its own centre of mass, in every sub-step.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

/// By contact of a group without deformable bodies: its gap where the sub-step will end, less the gap that J v says,
/// metres. Bodies end where they will with the group's Δv; prescribed ones where their velocity takes them. 0 of
/// attachments, and where a body turns so far that one straight step can't mean it.
std::vector<double> turning_errors(const Bodies& bodies, const AssembledGroup& group, const ContactList& contacts,
                                   double time_step);

}  // namespace impinge
