// Exact shapes as triangles, for drawing and for export.
#pragma once

#include "engine/bodies/shape.hpp"

namespace impinge {

/// A closed surface, counter-clockwise from outside, in the shape's own frame: box exact; sphere and capsule with their
/// vertices on the surface; a mesh as it is. A plane has none.
TriangleMesh tessellate(const Shape& shape);

}  // namespace impinge
