// The contact points of two convex solids from their gap: where a face or line of either lies on the other, points that
// hold it there, else the one point of the gap.
#pragma once

#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/geometry/convex/convex_gap.hpp"

namespace impinge {

/// At most this many points of a manifold, beside the gap's own.
constexpr int kMostManifold = 8;

/// A contact face in world coordinates.
ContactFace world_face(const ContactFace& face, const Pose& pose);

/// Of the candidates, which all face the same way, those that span what they all hold: first of the lowest (within
/// `tie` metres of the lowest gap), then of the rest, the ones farthest out in eight directions across their normal,
/// kMostManifold at most. The directions turn with `pose`. Keeps the order.
void reduce_candidates(std::vector<Candidate>& candidates, const Pose& pose, double tie);

/// The contact points of two convex solids, first the sink's first: of their faces, clipped by each other, of two lines
/// side by side, and that of the gap itself where none of these is as low. Points keep their identity from step to
/// step, whichever of two parallel faces the normal is taken from.
std::vector<Candidate> convex_candidates(const PlacedConvex& first, const PlacedConvex& second, double reach);

}  // namespace impinge
