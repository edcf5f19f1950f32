#include "engine/shapes/wall.hpp"

namespace impinge {

double wall_of(const Shape& shape) {
  const double thickness = shape.thickness();
  const SurfaceMesh* surface = shape.mesh();
  if (surface == nullptr || !surface->topology.is_closed()) return thickness;
  const double size = shape.size();  // 6 V / A: of a ball and a cube the smallest side, of walls three times their own
  return 2.0 * size < thickness ? size / 3.0 : thickness;
}

}  // namespace impinge
