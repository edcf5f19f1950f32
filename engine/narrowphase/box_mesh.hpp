// Contacts between a box and a mesh. Internal to the narrow phase: callers use primitive.hpp.
#pragma once

#include "engine/narrowphase/primitive.hpp"

namespace impinge {

void box_mesh_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query, std::vector<Collision>& contacts);

}  // namespace impinge
