// Collision groups: bodies connected by contacts, each solved on its own. [Haapaoja16 §3.2.4]
#pragma once

#include <span>

#include "engine/contact/contact_list.hpp"

namespace impinge {

struct CollisionGroup {
  std::vector<BodyIndex> bodies;       ///< with freedom, ascending
  std::vector<ContactIndex> contacts;  ///< ascending
};

/// Union-find over the pairs (a, b) of contacts. Only bodies with joins[body] connect groups: a static or scripted body
/// joins nothing. Contacts between two bodies that don't join, and those of no body, are left out. Groups in order of
/// their lowest body.
std::vector<CollisionGroup> make_groups(std::span<const std::pair<BodyIndex, BodyIndex>> contacts,
                                        const std::vector<char>& joins);

/// The groups of a sub-step. An attachment of bodies that are all asleep, or don't move, is left out.
std::vector<CollisionGroup> find_groups(const Bodies& bodies, const ContactList& contacts);

}  // namespace impinge
