#include "engine/shapes/wall.hpp"

#include "engine/geometry/mass_properties.hpp"

namespace impinge {

double wall_of(const Shape& shape) {
  constexpr double kCompact = 6.0;  // times what a wall would be: of a ball and a cube 3 make the smallest side
  const double thickness = thickness_of(shape);
  const SurfaceMesh* surface = shape.mesh();
  if (surface == nullptr || !surface->topology.is_closed()) return thickness;
  const std::vector<Vec3>& x = surface->mesh.vertices;
  double area = 0.0;
  for (const Triangle& t : surface->mesh.triangles) area += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
  const double wall = area > 0.0 ? 2.0 * signed_volume(surface->mesh) / area : 0.0;
  return wall > 0.0 && kCompact * wall < thickness ? wall : thickness;
}

}  // namespace impinge
