// Triangles of round shapes: rings about the y axis between two poles.
#pragma once

#include <array>

#include "engine/shapes/shape.hpp"

namespace impinge {

/// A closed outward surface with `around` vertices on each ring (distance from the axis, y), from below, and one vertex
/// at either pole.
TriangleMesh surface_of_revolution(const std::vector<Vec2>& rings, double y_below, double y_above, int around);

/// Cosine and sine of eight even angles about y: the points of a rim that a flat side rests on, which turn with the body.
const std::array<Vec2, 8>& rim_ways();

/// Of a shape that is round about its y axis, or null.
const ConvexSet* round_solid(const Shape& shape);

/// ConvexSet::rolled of what is round about y: where it is touched with the rim through `place` that goes round, and a
/// place that turns with the body stays.
Vec3 rolled_about_y(const Vec3& place, const Vec3& from, const Vec3& to);

}  // namespace impinge
