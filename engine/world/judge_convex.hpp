// How deep two convex solids overlap, from nothing but how far each reaches in a direction: the judge's own way, which
// shares no search with detection.
#pragma once

#include "engine/geometry/convex/minkowski.hpp"

namespace impinge {

/// The least motion that parts them, metres; 0 if a direction does part them. Polyhedra of few edges by all their
/// separating axes, others by sampling directions and searching about the best ones, right to 1e-7 of their size.
double least_overlap(const PlacedConvex& a, const PlacedConvex& b);

}  // namespace impinge
