// One triangle of a mesh as a convex set.
#pragma once

#include <array>

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// In the mesh's frame.
class TriangleSet final : public ConvexSet {
 public:
  TriangleSet(const TriangleMesh& mesh, int triangle) {
    for (int k = 0; k < 3; ++k)
      corners_[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[static_cast<std::size_t>(triangle)][k])];
  }
  Vec3 support(const Vec3& direction) const override {
    const double x = direction.dot(corners_[0]), y = direction.dot(corners_[1]), z = direction.dot(corners_[2]);
    return corners_[x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2)];
  }
  const std::array<Vec3, 3>& corners() const { return corners_; }

 private:
  std::array<Vec3, 3> corners_;
};

}  // namespace impinge
