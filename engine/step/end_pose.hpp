// Contacts are sought where a sub-step begins, and a surface that deforms is not where it was when it ends: it slides round
// what holds it, folds, and lies with other places on it than those that had contacts. Rigid bodies that approach fast turn
// on the way, and meet with other features than those that were nearest. So where the response leads is looked at, and an
// overlap there is a contact of the sub-step that ends so: the same material points, the normal of the end.
#pragma once

#include <optional>

#include "engine/step/detect.hpp"

namespace impinge {

/// Of a step that is solved: pairs whose end is worth a look. Those with a deforming body, rigid bodies that approach fast,
/// unless one hangs in the other, and those that are known to pass. `solved`: the colliders with the velocities that the
/// response gave to rigid bodies. Sorted.
std::vector<BodyPair> pairs_at_end(const Bodies& bodies, const ContactSettings& contact, const SubStep& step,
                                   std::span<const Collider> solved);

/// Overlaps of those pairs at its end, deeper than they were at its start and than contacts leave, of two rigid meshes the
/// few deepest. Points and gap are those of the start, in pair order; changes nothing.
std::vector<Collision> overlaps_at_end(const Bodies& bodies, const Detecting& by, const SubStep& step,
                                       std::span<const Collider> solved, std::span<const BodyPair> pairs);

/// By pair: their deepest contact where they stand, if they overlap.
std::vector<std::optional<Collision>> deepest_now(const Bodies& bodies, const Detecting& by,
                                                  std::vector<BodyPair> pairs);

/// By pair, of rigid bodies: how deep that is, metres; 0: they don't overlap.
std::vector<double> overlaps_now(const Bodies& bodies, const Detecting& by, std::vector<BodyPair> pairs);

/// Whether a contact that carries nothing shows an overlap: its points may be those of another end than the bodies came to, and
/// what is between them nothing.
bool is_idle_overlap(const Vec3& lambda, double gap, double activation);

/// Whether the two points of a contact have left each other sideways: what is between them is no longer what is between
/// their bodies. `apart`: from B's to A's, metres.
bool have_parted(const Vec3& apart, const Vec3& normal, double activation);

/// How deep the solved contacts of a step show bodies in one another where these stand, or `known` where that is more, metres.
/// Of one that is idle, or whose points have parted, and would be the deepest, and has a formula, detection says how deep it is.
double deepest_shown(const Bodies& bodies, const Detecting& by, std::span<const GroupResult> solved, double known);

/// How deep the contacts of a rigid body and one that can't respond say that they are in one another where a sub-step begins,
/// metres, of two of which at least one has a formula; no more than what is far from the other side of either.
double overlap_at_start(const Bodies& bodies, const SubStep& step, const BodyPair& pair);

/// Whether one of the two hangs in the other, as a pin does in its hole: their contacts push to all sides.
/// `collisions`: in pair order.
bool are_interlocked(std::span<const Collision> collisions, const BodyPair& pair);

}  // namespace impinge
