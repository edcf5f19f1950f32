// Contact points of two boxes that meet face to face: the one face clipped by the sides of the other.
#pragma once

#include "engine/detection/pairs/primitive_pairs.hpp"

namespace impinge {

/// Adds the points (at most eight) of the face of `incident` that opposes face `axis` of `reference` most, clipped by
/// the reference face's sides, each with its height above the reference face as gap. `outward`: unit normal of the
/// reference face, towards the incident box. `reference_is_first`: the reference box is the sink's first shape.
/// `overlapping`: the boxes overlap, so there must be a point below the face, if need be beside it.
/// Points keep their identity from step to step whichever of two parallel faces is the reference: corners that
/// coincide are named as a pair of corners, crossings as a pair of edges.
void add_face_manifold(ContactSink& sink, const OrientedBox& reference, const OrientedBox& incident, int axis,
                       const Vec3& outward, bool reference_is_first, bool overlapping);

}  // namespace impinge
