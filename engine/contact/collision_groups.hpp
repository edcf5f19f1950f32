// Collision groups: bodies connected by contacts, each solved on its own. [Haapaoja16 §3.2.4]
#pragma once

#include <span>

#include "engine/core/types.hpp"

namespace impinge {

struct CollisionGroup {
  std::vector<int> bodies;    ///< dynamic bodies, ascending
  std::vector<int> contacts;  ///< indices into the contact list, ascending
};

/// Union-find over the pairs (a, b) of contacts. Only bodies with joins[body] connect groups: a static or scripted body
/// joins nothing. Contacts between two bodies that don't join, and those of body -1, are left out. Groups in order of
/// their lowest body.
std::vector<CollisionGroup> make_groups(std::span<const std::pair<int, int>> contacts, const std::vector<char>& joins);

}  // namespace impinge
