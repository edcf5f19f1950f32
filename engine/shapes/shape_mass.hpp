// Mass properties of any shape.
#pragma once

#include "engine/geometry/mass_properties.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// Mass properties of a shape in the body's frame; density in kg/m³. A plane, which never moves, has none: all zero.
MassProperties shape_mass(const Shape& shape, double density);

}  // namespace impinge
