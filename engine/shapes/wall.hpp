// How thick a solid is where it is thin.
#pragma once

#include "engine/shapes/shape.hpp"

namespace impinge {

/// How thick what the solid is made of is, metres: of a hollow or branched closed mesh its walls, by twice the volume over
/// the area, which is exact for a plate and a shell; of all else the smallest side of its box.
double wall_of(const Shape& shape);

}  // namespace impinge
