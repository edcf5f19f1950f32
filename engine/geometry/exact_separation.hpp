// Whether moving features stay on the two sides of a plane, decided without rounding: what interval bounds cannot tell of
// features that pass within their own rounding of each other.
#pragma once

#include "engine/geometry/continuous.hpp"

namespace impinge {

/// True only if a plane of one direction lies strictly between the features at every moment, which proves that they never
/// meet. Directions that are tried: the axes, and the cross products of every two of the corners' edges and motions.
/// Coordinates beyond 2^200 or below 2^-200, whose products might not be exact, are not told.
bool is_vertex_kept_off_face(const MovingCorners& corners);
bool are_edges_kept_apart(const MovingCorners& corners);

}  // namespace impinge
