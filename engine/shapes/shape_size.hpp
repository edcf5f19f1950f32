// How large a solid is where it matters for contact.
#pragma once

#include "engine/shapes/shape.hpp"

namespace impinge {

/// 6 V / A, volume and surface: the diameter of the sphere that has as much volume a surface (Sauter's mean diameter),
/// metres. Of a cube its side, of a box the harmonic mean of its sides, of a sheet three times its thickness: where a
/// box round a body says how far it reaches, this says how thick it is, however the body lies and is cut into triangles.
/// Infinite of a plane. Of a surface that encloses nothing the side of the cube of its area.
double size_of(const Shape& shape);

}  // namespace impinge
