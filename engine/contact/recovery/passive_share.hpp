// What attachments take of their errors by velocities, as far as the motion pays for it: points that are pulled together
// faster than they left one another would win energy from nowhere, as a whip of light links under a heavy end does.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

/// Of a group that was solved without what its attachments ask for beside staying where they are, and with it: the largest
/// share, 0 to 1, with which its rigid bodies have no more kinetic energy than their free velocities, or than without.
double passive_share(const Bodies& bodies, const AssembledGroup& without, const AssembledGroup& with);

/// Asks the rows for this share of the recovery by velocities; drift: the rest, and what was left to positions before.
void ask_for_share(AssembledGroup& group, double share, double time_step);

}  // namespace impinge
