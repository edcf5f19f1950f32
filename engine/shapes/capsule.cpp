// A capsule along y: for contact a segment with a radius.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"
#include "engine/shapes/surface_of_revolution.hpp"

namespace impinge {
namespace {

constexpr int kDrawnAround = 32, kDrawnRings = 8;  // round the axis; from the equator of a cap to its pole
constexpr double kNearlyAcross = 0.25;             // sine of the angle up to which the wall faces a direction

}  // namespace

Capsule::Capsule(double radius_in_metres, double half_length_in_metres)
    : ConvexShape("capsule"), radius(radius_in_metres), half_length(half_length_in_metres) {}

Aabb Capsule::bounds(const Pose& pose) const {
  const Vec3 reach = (pose.rotation.col(1) * half_length).cwiseAbs() + Vec3::Constant(radius);
  return {pose.position - reach, pose.position + reach};
}

MassProperties Capsule::mass(double density) const { return capsule_mass(radius, half_length, density); }

double Capsule::signed_distance(const Vec3& x) const {
  return (x - Vec3(0, std::clamp(x.y(), -half_length, half_length), 0)).norm() - radius;
}

Vec3 Capsule::support(const Vec3& direction) const {
  return {0.0, direction.y() < 0.0 ? -half_length : half_length, 0.0};
}

ContactFace Capsule::facing(const Vec3& direction) const {
  ContactFace face;
  if (std::abs(direction.y()) > kNearlyAcross) {
    face.add(support(direction) + radius * direction);
    return face;
  }
  // the end that reaches farthest, and the other's side: both on the surface
  const Vec3 side = Vec3(direction.x(), 0.0, direction.z()).normalized();
  for (const double y : {-half_length, half_length})
    face.add(Vec3(0.0, y, 0.0) + radius * (y * direction.y() > 0.0 ? direction : side));
  return face;
}

TriangleMesh Capsule::surface(double edge) const {
  // half as long: ten to a ring would cut off 8 % of it
  const double around = std::ceil(2.0 * 6.2832 * radius / edge);
  return capsule_surface(radius, half_length, std::clamp(static_cast<int>(around), 8, 256));
}

/// Rings of vertices from the upper pole (+y) to the lower one.
TriangleMesh Capsule::drawn() const {
  // without length the two equators would be one ring and the wall between them triangles without area
  if (!(half_length > 0.0)) return sphere_surface(radius, 3);
  TriangleMesh mesh;
  const int rings = 2 * kDrawnRings, n = kDrawnAround;  // the two equators included, the poles not
  mesh.vertices.push_back({0.0, half_length + radius, 0.0});
  for (int i = 0; i < rings; ++i) {
    const bool upper = i < kDrawnRings;
    const double angle = 0.5 * M_PI * (upper ? i + 1 : rings - i) / kDrawnRings;  // from the cap's own pole
    const double r = radius * std::sin(angle);
    const double y = (upper ? 1.0 : -1.0) * (half_length + radius * std::cos(angle));
    for (int k = 0; k < n; ++k)
      mesh.vertices.push_back({r * std::sin(2.0 * M_PI * k / n), y, r * std::cos(2.0 * M_PI * k / n)});
  }
  mesh.vertices.push_back({0.0, -half_length - radius, 0.0});
  const auto at = [&](int ring, int k) { return 1 + ring * n + k % n; };
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  for (int k = 0; k < n; ++k) mesh.triangles.push_back({0, at(0, k), at(0, k + 1)});
  for (int i = 0; i + 1 < rings; ++i)
    for (int k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  for (int k = 0; k < n; ++k) mesh.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
  return mesh;
}

TriangleMesh capsule_surface(double radius, double half_length, int around) {
  const double edge = 2.0 * std::numbers::pi * radius / around;
  const int cap = std::max(2, (around + 2) / 4),
            side = std::max(1, static_cast<int>(std::lround(2.0 * half_length / edge)));
  std::vector<Vec2> profile;  // distance from the axis and y of each ring, poles left out, from below
  for (int i = 1; i <= cap; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / cap;
    profile.emplace_back(radius * std::sin(angle), -half_length - radius * std::cos(angle));
  }
  for (int i = 1; i < side; ++i) profile.emplace_back(radius, half_length * (2.0 * i / side - 1.0));
  for (int i = cap; i >= 1; --i) {
    const double angle = 0.5 * std::numbers::pi * i / cap;
    profile.emplace_back(radius * std::sin(angle), half_length + radius * std::cos(angle));
  }
  return surface_of_revolution(profile, -half_length - radius, half_length + radius, around);
}

ShapeEntry capsule_shape() {
  return {"capsule",
          "A cylinder along y with a half ball on either end.",
          {{"radius", ShapeKey::length, "of the cylinder and the half balls"},
           {"length", ShapeKey::length, "between the centres of the half balls"}},
          [](const ShapeValues& values) -> SharedShape {
            return Capsule(values.number("radius"), 0.5 * values.number("length"));
          }};
}

}  // namespace impinge
