// How deep edges of one closed mesh run through another between their ends: plates that cross like an X, or links that hang
// in one another edge on edge, overlap by that while no vertex of either is inside the other.
#pragma once

#include "engine/detection/contacts/enclosing_surface.hpp"

namespace impinge {

/// Puts into `deepest` the place between the ends of an edge of `own` that lies deeper inside `other` than it and than `known`, metres: within
/// 5 % of the deepest there is. `crossing`: the triangles of both that cross; `own_is_a`: whose is which.
void find_deepest_edge(const EnclosingSurface& own, const EnclosingSurface& other,
                       std::span<const TrianglePair* const> crossing, bool own_is_a, double known,
                       std::optional<Collision>& deepest);

}  // namespace impinge
