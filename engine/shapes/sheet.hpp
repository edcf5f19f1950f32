// Solids that are thin to another.
#pragma once

#include <algorithm>

#include "engine/shapes/faceted.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/wall.hpp"

namespace impinge {

/// Of two solids of which one's surface is triangles: how thick the one is where the other's walls are less than a hundredth
/// of that, a mere sheet to it, metres; else 0.
inline double thick_beside_sheet(const Shape& a, const Shape& b) {
  constexpr double kSheet = 0.01;
  if (a.as<Plane>() != nullptr || b.as<Plane>() != nullptr) return 0.0;
  if (!is_faceted(a) && !is_faceted(b)) return 0.0;
  const double of_a = wall_of(a), of_b = wall_of(b), thick = std::max(of_a, of_b);
  return std::min(of_a, of_b) < kSheet * thick ? thick : 0.0;
}

}  // namespace impinge
