// A half-space. It has no mass, no bounds and no finite surface, and never moves by itself.
#include "engine/core/error.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {

Plane::Plane(const Vec3& unit_normal, double distance) : Shape("plane"), normal(unit_normal), offset(distance) {}

Aabb Plane::bounds(const Pose& pose) const {
  const double inf = std::numeric_limits<double>::infinity();
  Aabb box{Vec3::Constant(-inf), Vec3::Constant(inf)};
  // the half-space behind an axis-aligned plane has a bound on that side
  const Vec3 n = pose.rotation * normal;
  const double distance = offset + n.dot(pose.position);
  for (int k = 0; k < 3; ++k) {
    if (n[k] == 1.0) box.max[k] = distance;
    if (n[k] == -1.0) box.min[k] = -distance;
  }
  return box;
}

TriangleMesh Plane::surface(double) const { throw InternalError("a plane has no finite surface to tessellate"); }

ShapeEntry plane_shape() {
  return {"plane",
          "The half-space normal·x <= offset; static or scripted, never dynamic.",
          {{"normal", ShapeKey::direction, "outward; with offset as it is written: both scale together"},
           {"offset", ShapeKey::coordinate, "of the surface along the normal", false}},
          [](const ShapeValues& values) -> SharedShape {
            const Vec3 n = values.vector("normal");
            const double offset = values.number("offset"), length = n.norm();
            // a unit normal keeps its bits
            if (length == 1.0) return Plane(n, offset);
            return Plane(n / length, offset / length);
          },
          "has no bounds"};
}

}  // namespace impinge
