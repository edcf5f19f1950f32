// Fewer contacts for the same freedom: of the contacts of two bodies those stay that can come to carry. Where one
// deforms, see without_flat_crossings (detection/contacts).
//
// Between rigid bodies contacts of one normal are a patch. A rigid motion changes their gaps by an affine function of
// the place in the patch, so a contact inside the others' polygon whose gap is no smaller than theirs there is never the
// first to close, and its impulse is a sum of theirs with the same force and torque. What has to stay is the lower hull
// of gap over place: the corners of the support polygon, the deepest contact, and on curved surfaces those that a small
// tilt makes the deepest.
#pragma once

#include <span>
#include <vector>

#include "engine/bodies/bodies.hpp"
#include "engine/contact/contact_cache.hpp"
#include "engine/contact/contact_settings.hpp"
#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

struct ReductionSettings {
  double activation = 1e-3;  ///< metres; what carried is preferred by a hundredth of it
  int most = 100;            ///< contacts of a pair from which on its patches are made coarser
};

/// Takes from `collisions`, sorted by pair, what need not respond, and returns it; the order stays in both. Contacts of the
/// features of `asked` always stay. What carried an impulse in the last sub-step (`carried`) is preferred, so that a set
/// of contacts lasts.
std::vector<Collision> reduce_contacts(const Bodies& bodies, const ContactCache& carried,
                                       std::span<const Collider> colliders, std::span<const Collision> asked,
                                       const ContactSettings& contact, std::vector<Collision>& collisions);

/// Which contacts of one pair of rigid bodies stay: 1 or 0 by contact. `is_preferred` by contact.
std::vector<char> contacts_that_stay(std::span<const Collision> contacts, const std::vector<char>& is_preferred,
                                     const ReductionSettings& how);

}  // namespace impinge
