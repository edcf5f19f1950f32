// A solid cylinder about y. It rests on its caps by eight points of the rim, which turn with it, and by the lowest
// point of the rim where it leans; on its side by the two ends of a line.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/shapes/shape_entry.hpp"
#include "engine/shapes/surface_of_revolution.hpp"

namespace impinge {
namespace {

constexpr int kCylinderSides = 48;
constexpr double kWallFaces = 0.2431;  // sine of 14 degrees: how steep to a direction the wall may be that faces it

class Cylinder final : public ConvexShape {
 public:
  Cylinder(double radius, double half_length) : ConvexShape("cylinder"), radius_(radius), half_(half_length) {}

  Aabb bounds(const Pose& pose) const override {
    const Vec3 axis = pose.rotation.col(1);
    const Vec3 reach = half_ * axis.cwiseAbs() + radius_ * (1.0 - axis.array().square()).max(0.0).sqrt().matrix();
    return {pose.position - reach, pose.position + reach};
  }
  double bounding_radius() const override { return std::hypot(radius_, half_); }
  MassProperties mass(double density) const override {
    MassProperties m;
    m.mass = density * 2.0 * std::numbers::pi * radius_ * radius_ * half_;
    const double across = m.mass * (0.25 * radius_ * radius_ + half_ * half_ / 3.0);
    m.inertia.diagonal() = Vec3(across, 0.5 * m.mass * radius_ * radius_, across);
    return m;
  }
  double signed_distance(const Vec3& x) const override {
    const double beside = std::hypot(x.x(), x.z()) - radius_, above = std::abs(x.y()) - half_;
    return std::hypot(std::max(beside, 0.0), std::max(above, 0.0)) + std::min(std::max(beside, above), 0.0);
  }
  Vec3 outward(const Vec3& x) const override {
    const double across = std::sqrt(x.x() * x.x() + x.z() * x.z());
    const double beside = across - radius_, above = std::abs(x.y()) - half_, side = x.y() < 0.0 ? -1.0 : 1.0;
    const Vec3 radial = across > 0.0 ? Vec3(x.x() / across, 0.0, x.z() / across) : Vec3(Vec3::UnitX());
    if (beside > 0.0 && above > 0.0) return (beside * radial + above * side * Vec3::UnitY()).normalized();
    return beside > above ? radial : Vec3(side * Vec3::UnitY());
  }
  Vec3 support(const Vec3& d) const override {
    const double across = std::hypot(d.x(), d.z()), y = d.y() < 0.0 ? -half_ : half_;
    if (!(across > 0.0)) return {0.0, y, 0.0};
    return {radius_ * d.x() / across, y, radius_ * d.z() / across};
  }
  ContactFace facing(const Vec3& d) const override {
    ContactFace face;
    if (std::abs(d.y()) > kNearlyFacing) {
      const double side = d.y() < 0.0 ? -1.0 : 1.0;
      face.face = side < 0.0 ? 0 : 1;
      face.normal = {0.0, side, 0.0};
      for (const Vec2& way : rim_ways()) face.add({radius_ * way.x(), side * half_, -radius_ * (side * way.y())});
      return face;
    }
    face.face = 2;
    if (std::abs(d.y()) > kWallFaces) {
      face.add(support(d));
      return face;
    }
    const Vec3 lowest = support({d.x(), 0.0, d.z()});
    for (const double y : {-half_, half_}) face.add({lowest.x(), y, lowest.z()});
    return face;
  }
  bool is_round_about_y() const override { return true; }
  Vec3 rolled(const Vec3& place, const Vec3& from, const Vec3& to) const override {
    return rolled_about_y(place, from, to);
  }
  TriangleMesh surface(double edge) const override {
    // half as long round the rim: ten to a ring would cut off 6 % of it
    const int around = std::clamp(static_cast<int>(std::ceil(4.0 * std::numbers::pi * radius_ / edge)), 12, 256);
    const int side = rings(2.0 * half_, edge), cap = rings(radius_, edge);
    std::vector<Vec2> profile;
    for (int i = 1; i <= cap; ++i) profile.emplace_back(radius_ * i / cap, -half_);
    for (int i = 1; i < side; ++i) profile.emplace_back(radius_, half_ * (2.0 * i / side - 1.0));
    for (int i = cap; i >= 1; --i) profile.emplace_back(radius_ * i / cap, half_);
    return surface_of_revolution(profile, -half_, half_, around);
  }
  TriangleMesh drawn() const override {
    return surface_of_revolution({{radius_, -half_}, {radius_, half_}}, -half_, half_, kCylinderSides);
  }
  std::vector<double> dimensions() const override { return {radius_, half_}; }

 private:
  static int rings(double length, double edge) {
    return std::clamp(static_cast<int>(std::lround(length / edge)), 1, 512);
  }

  double radius_, half_;
};

}  // namespace

ShapeEntry cylinder_shape() {
  return {"cylinder",
          "A solid cylinder about y, its middle in the origin.",
          {{"radius", ShapeKey::length, "of the caps"}, {"length", ShapeKey::length, "between the caps"}},
          [](const ShapeValues& values) -> SharedShape {
            return Cylinder(values.number("radius"), 0.5 * values.number("length"));
          }};
}

}  // namespace impinge
