// An example of a shape: an ellipsoid about the origin. Contacts come from its support function alone.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/shapes/shape_entry.hpp"
#include "engine/shapes/surface_of_revolution.hpp"

namespace impinge {
namespace {

class Ellipsoid final : public ConvexShape {
 public:
  explicit Ellipsoid(const Vec3& half) : ConvexShape("ellipsoid"), half_(half) {}

  Vec3 support(const Vec3& d) const override { return half_.cwiseProduct(half_.cwiseProduct(d).normalized()); }
  MassProperties mass(double density) const override {
    MassProperties m;
    m.mass = density * 4.0 / 3.0 * std::numbers::pi * half_.prod();
    const Vec3 squares = half_.cwiseAbs2();
    m.inertia.diagonal() = 0.2 * m.mass * (Vec3::Constant(squares.sum()) - squares);
    return m;
  }
  TriangleMesh surface(double edge) const override {
    const int rings = std::clamp(static_cast<int>(std::lround(std::numbers::pi * half_.maxCoeff() / edge)), 6, 128);
    std::vector<Vec2> profile;
    for (int i = 1; i < rings; ++i) {
      const double angle = std::numbers::pi * i / rings;
      profile.emplace_back(std::sin(angle), -std::cos(angle));
    }
    TriangleMesh mesh = surface_of_revolution(profile, -1.0, 1.0, 2 * rings);
    for (Vec3& x : mesh.vertices) x = x.cwiseProduct(half_);
    return mesh;
  }
  std::vector<double> dimensions() const override { return {half_.x(), half_.y(), half_.z()}; }

 private:
  Vec3 half_;
};

}  // namespace

ShapeEntry ellipsoid_shape() {
  return {"ellipsoid",
          "An ellipsoid about the origin, its axes along x, y, z.",
          {{"size", ShapeKey::lengths, "full lengths along x, y, z"}},
          [](const ShapeValues& values) -> SharedShape { return Ellipsoid(0.5 * values.vector("size")); }};
}

}  // namespace impinge
