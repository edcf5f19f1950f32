// A solid cone about y. It rests on its base by eight points of the rim, which turn with it, and by the lowest point of
// the rim where it leans; on its side by the apex and a point of the rim.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/shapes/shape_entry.hpp"
#include "engine/shapes/surface_of_revolution.hpp"

namespace impinge {
namespace {

constexpr int kConeSides = 48;

class Cone final : public ConvexShape {
 public:
  /// `base`, `apex`: where they are on the y axis, base < apex.
  Cone(double radius, double base, double apex) : ConvexShape("cone"), radius_(radius), base_(base), apex_(apex) {}

  double bounding_radius() const override { return std::max(std::abs(apex_), std::hypot(radius_, base_)); }
  MassProperties mass(double density) const override {
    const double length = apex_ - base_;
    MassProperties m;
    m.mass = density * std::numbers::pi * radius_ * radius_ * length / 3.0;
    m.center = {0.0, base_ + 0.25 * length, 0.0};
    const double across = m.mass * (0.15 * radius_ * radius_ + 0.0375 * length * length);
    m.inertia.diagonal() = Vec3(across, 0.3 * m.mass * radius_ * radius_, across);
    return m;
  }
  SharedShape recentered(const Vec3& center) const override {
    return Cone(radius_, base_ - center.y(), apex_ - center.y());
  }
  double signed_distance(const Vec3& x) const override {
    // in the half-plane of x: distance from the axis, height over the base
    const double length = apex_ - base_, slant = std::hypot(radius_, length);
    const double r = std::hypot(x.x(), x.z()), h = x.y() - base_;
    const double wall = ((r - radius_) * length + h * radius_) / slant;
    if (wall <= 0.0 && h >= 0.0) return std::max(wall, -h);
    // along the wall from the rim to the apex, and across the base
    const double t = std::clamp(((radius_ - r) * radius_ + h * length) / (slant * slant), 0.0, 1.0);
    const double to_wall = std::hypot(r - radius_ * (1.0 - t), h - length * t);
    return std::min(to_wall, std::hypot(std::max(r - radius_, 0.0), h));
  }
  Vec3 outward(const Vec3& x) const override {
    const double length = apex_ - base_, slant = std::sqrt(radius_ * radius_ + length * length);
    const double r = std::sqrt(x.x() * x.x() + x.z() * x.z()), h = x.y() - base_;
    const Vec3 radial = r > 0.0 ? Vec3(x.x() / r, 0.0, x.z() / r) : Vec3(Vec3::UnitX());
    const auto way = [&](const Vec2& d) { return Vec3(d.x() * radial + d.y() * Vec3::UnitY()); };
    const Vec2 off_wall = Vec2(length, radius_) / slant;
    const double wall = off_wall.dot(Vec2(r - radius_, h));
    if (wall <= 0.0 && h >= 0.0) return wall >= -h ? way(off_wall) : Vec3(-Vec3::UnitY());
    const double t = std::clamp(((radius_ - r) * radius_ + h * length) / (slant * slant), 0.0, 1.0);
    const Vec2 to_wall(r - radius_ * (1.0 - t), h - length * t), to_base(std::max(r - radius_, 0.0), h);
    const Vec2 nearest = to_wall.squaredNorm() < to_base.squaredNorm() ? to_wall : to_base;
    return nearest.isZero(0.0) ? way(off_wall) : way(nearest.normalized());
  }
  Vec3 support(const Vec3& d) const override {
    const double across = std::hypot(d.x(), d.z());
    if (d.y() * (apex_ - base_) >= radius_ * across) return {0.0, apex_, 0.0};
    return rim(d, across);
  }
  ContactFace facing(const Vec3& d) const override {
    ContactFace face;
    if (-d.y() > kNearlyFacing) {
      face.normal = {0.0, -1.0, 0.0};
      for (const Vec2& way : rim_ways()) face.add({radius_ * way.x(), base_, radius_ * way.y()});
      return face;
    }
    face.face = 1;
    const double length = apex_ - base_, across = std::hypot(d.x(), d.z());
    const bool is_wall = across * length + d.y() * radius_ > kNearlyFacing * std::hypot(radius_, length);
    if (is_wall) {
      face.add(rim(d, across));
      face.add({0.0, apex_, 0.0});
    } else {
      face.add(support(d));
    }
    return face;
  }
  std::vector<Vec3> tips() const override { return {{0.0, apex_, 0.0}}; }
  bool is_round_about_y() const override { return true; }
  Vec3 rolled(const Vec3& place, const Vec3& from, const Vec3& to) const override {
    return rolled_about_y(place, from, to);
  }
  TriangleMesh surface(double edge) const override {
    const double length = apex_ - base_;
    const int around = std::clamp(static_cast<int>(std::ceil(4.0 * std::numbers::pi * radius_ / edge)), 12, 256);
    const int wall = rings(std::hypot(radius_, length), edge), cap = rings(radius_, edge);
    std::vector<Vec2> profile;
    for (int i = 1; i <= cap; ++i) profile.emplace_back(radius_ * i / cap, base_);
    for (int i = 1; i < wall; ++i) profile.emplace_back(radius_ * (wall - i) / wall, base_ + length * i / wall);
    return surface_of_revolution(profile, base_, apex_, around);
  }
  TriangleMesh drawn() const override { return surface_of_revolution({{radius_, base_}}, base_, apex_, kConeSides); }
  std::vector<double> dimensions() const override { return {radius_, base_, apex_}; }

 private:
  Vec3 rim(const Vec3& d, double across) const {
    if (!(across > 0.0)) return {0.0, base_, 0.0};
    return {radius_ * d.x() / across, base_, radius_ * d.z() / across};
  }
  static int rings(double length, double edge) {
    return std::clamp(static_cast<int>(std::lround(length / edge)), 1, 512);
  }

  double radius_, base_, apex_;
};

}  // namespace

ShapeEntry cone_shape() {
  return {"cone",
          "A solid cone about y, the middle of its height in the origin, its apex at +length/2.",
          {{"radius", ShapeKey::length, "of the base"}, {"length", ShapeKey::length, "from the base to the apex"}},
          [](const ShapeValues& values) -> SharedShape {
            const double half = 0.5 * values.number("length");
            return Cone(values.number("radius"), -half, half);
          }};
}

}  // namespace impinge
