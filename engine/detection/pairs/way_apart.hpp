// The way out of a mesh for a convex solid that is deep in it.
#pragma once

#include <optional>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

/// Deep in each other no feature of the mesh needs to lie where the solid would leave it. Then the way out is the shortest of
/// those along which it leaves all of the triangles that it meets by more than `touch` metres, as far as they are within
/// `bounds`, which are its own. Nothing if it meets none.
std::optional<Candidate> way_apart(const SurfaceView& mesh, const PlacedConvex& solid, const Aabb& bounds,
                                   const std::vector<int>& triangles, double touch);

}  // namespace impinge
