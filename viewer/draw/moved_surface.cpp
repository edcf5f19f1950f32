#include "viewer/draw/moved_surface.hpp"

#include "engine/geometry/aabb.hpp"

namespace impinge {

MovedSurface move_surface(const ShadedSurface& rest, std::span<const Vec3> vertices, bool everted) {
  MovedSurface out;
  Aabb box;
  for (const Vec3& v : vertices) box.include(v);
  if (!box.is_empty()) out.origin = box.center();  // small numbers in single precision, wherever the body is
  out.positions.resize(rest.positions.size());
  out.normals.assign(rest.positions.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < out.positions.size(); ++i) {
    out.positions[i] = (vertices[rest.source[i]] - out.origin).cast<float>();
    out.bounds.extend(out.positions[i]);
  }
  for (const auto& [a, b, c] : rest.triangles) {
    const Eigen::Vector3f& p = out.positions[a];
    const Eigen::Vector3f area = (out.positions[b] - p).cross(out.positions[c] - p);
    for (const std::uint32_t corner : {a, b, c}) out.normals[corner] += area;
  }
  for (Eigen::Vector3f& normal : out.normals) {
    const float length = normal.norm();
    normal = length > 0.0f ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitY();
  }
  out.solid = rest.solid && !everted;
  return out;
}

}  // namespace impinge
