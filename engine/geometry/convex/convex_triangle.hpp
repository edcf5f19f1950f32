// A triangle as a convex set, to be held against a solid.
#pragma once

#include <algorithm>

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class ConvexTriangle final : public ConvexSet {
 public:
  explicit ConvexTriangle(const TriangleCorners& corners) : corners_(corners) {}
  /// Of a mesh, in its frame.
  ConvexTriangle(const TriangleMesh& mesh, int triangle) {
    const Triangle& of = mesh.triangles[static_cast<std::size_t>(triangle)];
    for (int k = 0; k < 3; ++k) corners_[k] = mesh.vertices[static_cast<std::size_t>(of[k])];
  }
  Vec3 support(const Vec3& d) const override {
    return *std::max_element(corners_.begin(), corners_.end(),
                             [&](const Vec3& l, const Vec3& r) { return l.dot(d) < r.dot(d); });
  }
  const TriangleCorners& corners() const { return corners_; }

 private:
  TriangleCorners corners_;
};

}  // namespace impinge
