// Fewer contacts that carry what all of them do. Impulses of two bodies on each other have a force and a torque: six
// numbers, which a non-negative sum of at most six of them has too [Caratheodory07]. An impulse made shorter stays in its
// friction cone, sticks or slides as it did, so an exact answer to the contact problem stays one.
#pragma once

#include <span>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

struct CarriedImpulse {
  Vec3 point = Vec3::Zero();    ///< metres
  Vec3 impulse = Vec3::Zero();  ///< N·s, not zero
};

/// By what each impulse is to be multiplied, none by less than 0, so that their force and torque stay and no more than
/// `most` carry; 0 where one carries no longer. More than `most` where those have no more to spare, six as a rule. What
/// carries least goes first.
std::vector<double> fewer_carriers(std::span<const CarriedImpulse> impulses, std::size_t most);

}  // namespace impinge
