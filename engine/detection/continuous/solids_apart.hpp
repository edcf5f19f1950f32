// Convex solids on their way, told apart by planes that go along with one of the two: where bodies touch, rest and tumble
// together, one stands between them nearly all the time, and no feature needs to be searched for the moment at which it
// meets another.
#pragma once

#include "engine/detection/continuous/surface_path.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// Whether two rigid bodies of convex solids are known to overlap nowhere by more than `depth`, metres, all along their
/// paths. False where it isn't known: then their surfaces have to be searched.
bool stay_apart(const Shape& a, const SurfacePath& of_a, const Shape& b, const SurfacePath& of_b, double depth);

/// The same of a body of convex solids and the triangles of a rigid mesh, whatever surface they make.
bool stay_off(const Shape& solid, const SurfacePath& own, const SurfacePath& triangles, double depth);

}  // namespace impinge
