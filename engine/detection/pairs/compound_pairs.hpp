// Compounds against everything: each part by itself.
#pragma once

#include "engine/detection/pairs/primitive.hpp"

namespace impinge {

/// Appends the contacts of body pair (a, b), of which one or both are compounds. A contact keeps its part in its
/// feature. Contacts at one place are one, and those of a seam that another part covers are left out.
void compound_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                       std::vector<Collision>& contacts);

}  // namespace impinge
