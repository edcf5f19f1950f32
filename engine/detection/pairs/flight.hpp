// Rigid bodies that are apart where a sub-step begins and come together within it. The plane between their nearest places
// at the start says little of where they meet, and nothing of whether they do: one that flies past the other crosses that
// plane, too. So they are looked at where they come near each other.
#pragma once

#include <optional>

#include "engine/detection/pairs/primitive.hpp"

namespace impinge {

/// The first time, in seconds from now, at which two rigid bodies that go on at their velocities may be within `near`
/// metres of each other; of what is hollow the convex hull counts. None: never within `time_step`. By conservative
/// advancement [Mirtich96]. Not both are planes, and none of them turns.
std::optional<double> time_until_near(const Collider& a, const Collider& b, double near, double time_step);

/// Whether both are rigid and approach so fast that it matters where within the time step they meet; not of contacts
/// that are within the activation distance already, or, of two balls, a fiftieth of it: a box that stands on another, a
/// pin, an arm need their contacts from that distance on.
bool fly_together(const Collider& a, const Collider& b, const ContactQuery& query, std::span<const Collision> found);

/// The time at which the two are looked at, as time_until_near has it for a part of the activation distance. With
/// `query.either_may_stop` none where they don't meet however each is stopped on its way, else 0.
std::optional<double> time_of_meeting(const Collider& a, const Collider& b, const ContactQuery& query);

/// A test of a pair of bodies: appends their contacts.
using PairContacts = void (*)(std::span<const Collider>, const BodyPair&, const ContactQuery&, std::vector<Collision>&);

/// What `test` finds of the pair at that time. Rows act as they will then, on either body, and their gaps close when they
/// do; what would close after the first of them, and lies on another face, is left out.
std::vector<Collision> contacts_where_they_meet(std::span<const Collider> colliders, const BodyPair& pair,
                                                const ContactQuery& query, double time, PairContacts test);

}  // namespace impinge
