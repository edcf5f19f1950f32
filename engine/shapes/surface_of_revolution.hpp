// Triangles of round shapes: rings about the y axis between two poles.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// A closed outward surface with `around` vertices on each ring (distance from the axis, y), from below, and one vertex
/// at either pole.
TriangleMesh surface_of_revolution(const std::vector<Vec2>& rings, double y_below, double y_above, int around);

}  // namespace impinge
