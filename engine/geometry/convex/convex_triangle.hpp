// A triangle as a convex set, to be held against a solid.
#pragma once

#include <algorithm>

#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

class ConvexTriangle final : public ConvexSet {
 public:
  explicit ConvexTriangle(const TriangleCorners& corners) : corners_(corners) {}
  Vec3 support(const Vec3& d) const override {
    return *std::max_element(corners_.begin(), corners_.end(),
                             [&](const Vec3& l, const Vec3& r) { return l.dot(d) < r.dot(d); });
  }

 private:
  TriangleCorners corners_;
};

}  // namespace impinge
