// Recovery from overlap of rigid bodies that nothing but one another holds. Putting a body elsewhere changes x × p, and
// turning it what its spin weighs: the group would win angular momentum, or energy, from nowhere.
#pragma once

#include <span>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/collision_groups.hpp"

namespace impinge {

/// Displaces the rigid bodies of a group, `by` body, metres and radians. The angular momentum about their common centre
/// that this takes is given back as a turn of the whole, as one body. That may cost energy: as much of it as contact took in
/// this sub-step, `taken`, J, and what it brings to slow the bodies against one another by a thousandth. Where that is not
/// enough a part of the angular momentum stays lost; energy is never won.
void displace_floating(Bodies& bodies, std::span<const BodyIndex> group, std::span<const BodyVector> by, double taken);

}  // namespace impinge
