#include "engine/shapes/shape_size.hpp"

#include <cmath>

#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

double size_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles)
    area += 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
  const double volume = signed_volume(mesh);
  return volume > 0.0 ? 6.0 * volume / area : std::sqrt(area / 6.0);
}

}  // namespace

double size_of(const Shape& shape) {
  if (shape.as<Plane>() != nullptr) return INFINITY;
  if (const auto* sphere = shape.as<Sphere>()) return 2.0 * sphere->radius;
  if (const auto* box = shape.as<Box>()) return 6.0 / box->half.cwiseInverse().sum();
  if (const SurfaceMesh* mesh = shape.mesh())  // which many shapes may share
    return mesh->lazy_size.get([&] { return size_of(mesh->mesh); });
  return size_of(shape.drawn());
}

}  // namespace impinge
