// Triangles that stand for exact shapes where triangles are wanted: in pictures and in exported surfaces.
#pragma once

#include "engine/shapes/shape.hpp"

namespace impinge {

/// A closed outward surface in the body's frame, inscribed in the shape; always the same triangles for the same shape.
/// A mesh is returned as it is. Throws InternalError for a plane, which has no finite surface.
TriangleMesh tessellate(const Shape& shape);

}  // namespace impinge
