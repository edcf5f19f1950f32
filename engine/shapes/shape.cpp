#include "engine/shapes/shape.hpp"

#include <cmath>

#include "engine/core/error.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_point.hpp"
#include "engine/shapes/shape_entry.hpp"
#include "engine/shapes/shape_size.hpp"

namespace impinge {
namespace {

constexpr double kDrawnEdges = 24.0;  // along the longest side

}  // namespace

Shape::Shape(std::string_view name, const SurfaceMesh* mesh) : type_(shape_type(name)), mesh_(mesh) {}

std::string_view Shape::name() const { return shape_entries()[static_cast<std::size_t>(type_)].name; }

SharedShape Shape::recentered(const Vec3& center) const {
  IMPINGE_ASSERT(center.isZero(0.0));
  return SharedShape(shared_from_this());
}

Vec3 Shape::outward(const Vec3& x) const {
  const double step = 1e-6 * size();
  Vec3 slope;
  for (int k = 0; k < 3; ++k) {
    const Vec3 way = step * Vec3::Unit(k);
    slope[k] = signed_distance(x + way) - signed_distance(x - way);
  }
  const double length = slope.norm();
  return length > 0.0 ? Vec3(slope / length) : Vec3(Vec3::UnitY());
}

TriangleMesh Shape::drawn() const { return surface(bounds({}).extent().maxCoeff() / kDrawnEdges); }

Aabb ConvexShape::bounds(const Pose& pose) const {
  Aabb box;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 direction = sign * pose.rotation.row(k).transpose();
      const double far = pose.rotation.row(k).dot(support(direction)) + pose.position[k] + sign * rounding();
      (sign > 0.0 ? box.max : box.min)[k] = far;
    }
  return box;
}

double ConvexShape::bounding_radius() const {
  const Aabb box = bounds({});
  return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
}

double ConvexShape::signed_distance(const Vec3& x) const {
  const ConvexPoint point;
  return convex_gap({&point, {Mat3::Identity(), x}}, {this, {}}).gap;
}

double Shape::size() const {
  return size_.get([&] { return size_of(*this); });
}

double Shape::thickness() const {
  return thickness_.get([&] {
    if (mesh() == nullptr) return bounds({}).extent().minCoeff();
    Aabb box;
    for (const Vec3& x : mesh()->mesh.vertices) box.include(x);
    return box.extent().minCoeff();
  });
}

}  // namespace impinge
