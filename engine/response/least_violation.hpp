// What is answered where contacts contradict each other: a body between two closing walls can't obey both.
#pragma once

#include "engine/contact/group_system.hpp"

namespace impinge {

/// Whether `group`, solved without convergence, shows impulses that grow along a ray on which they move nothing: -q^T λ
/// far above λ^T W λ, which are equal at an answer. Then replaces λ and Δv by the velocities that violate the rows
/// least, in the sum of their squares weighted with the mass that each row feels; friction is left out, since normal
/// forces have no bound there. If the rows turn out to have an answer after all, the group stays as it was. Returns
/// whether they contradict each other.
bool settle_contradiction(GroupSystem& group);

}  // namespace impinge
