// On which side of a closed surface many points lie.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Counts the triangles that a ray from the point meets, with their orientation. A grid across the rays makes that a
/// few triangles a point. The rays' direction is one that no lattice and no symmetric model has; where a ray still
/// passes an edge or a vertex within rounding, the sum of solid angles decides instead [VanOosterom83].
class SurfaceSide {
 public:
  /// Triangles of a closed, oriented surface; `vertices` must outlive this.
  SurfaceSide(std::span<const Vec3> vertices, std::vector<Triangle> triangles);

  /// The surface's winding number round x: 0 outside, ±1 inside, more where the surface overlaps itself. Nothing where
  /// x lies on the surface to within 1e-10 of its size, or so close to it that rounding would decide.
  std::optional<int> winding(const Vec3& x) const;

 private:
  int cell_of(int axis, double value) const;

  std::span<const Vec3> vertices_;
  std::vector<Triangle> triangles_;
  Vec3 origin_ = Vec3::Zero();               // amid the surface, so that nothing cancels far from the world's origin
  std::vector<std::array<Vec3, 3>> turned_;  // corners from there, turned so that rays run along z
  Aabb box_;
  int cells_ = 1;                    // along x and y each
  std::vector<int> begin_, member_;  // triangles over each cell
};

}  // namespace impinge
