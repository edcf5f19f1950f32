#include "engine/shapes/surface_of_revolution.hpp"

#include <cmath>
#include <numbers>

namespace impinge {

TriangleMesh surface_of_revolution(const std::vector<Vec2>& profile, double y_below, double y_above, int around) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0.0, y_below, 0.0);
  for (const Vec2& ring : profile)
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / around;
      mesh.vertices.emplace_back(ring.x() * std::cos(angle), ring.y(), -ring.x() * std::sin(angle));
    }
  const int top = static_cast<int>(mesh.vertices.size()), rings = static_cast<int>(profile.size());
  mesh.vertices.emplace_back(0.0, y_above, 0.0);
  const auto at = [&](int ring, int k) { return 1 + ring * around + k % around; };
  for (int k = 0; k < around; ++k) {
    mesh.triangles.push_back({0, at(0, k + 1), at(0, k)});
    for (int r = 0; r + 1 < rings; ++r)
      mesh.triangles.insert(mesh.triangles.end(),
                            {{at(r, k), at(r, k + 1), at(r + 1, k + 1)}, {at(r, k), at(r + 1, k + 1), at(r + 1, k)}});
    mesh.triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), top});
  }
  return mesh;
}

const std::array<Vec2, 8>& rim_ways() {
  static const std::array<Vec2, 8> ways = [] {
    std::array<Vec2, 8> all;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(all.size());
      all[k] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return ways;
}

const ConvexSet* round_solid(const Shape& shape) {
  const ShapeForm form = shape.form();
  const auto* solid = std::get_if<const ConvexSet*>(&form);
  return solid != nullptr && (*solid)->is_round_about_y() ? *solid : nullptr;
}

Vec3 rolled_about_y(const Vec3& place, const Vec3& from, const Vec3& to) {
  constexpr double kSame = 1e-6;  // of the rim's radius, and the sine of the least angle at which it is one place
  const Vec2 rim(place.x(), place.z()), side(from.x(), from.z()), side_then(to.x(), to.z());
  const double radius = rim.norm(), lean = side.norm(), lean_then = side_then.norm();
  if (!(lean > kSame && lean_then > kSame)) return place;
  if (!((rim - radius / lean * side).norm() <= kSame * radius)) return place;
  return {radius / lean_then * side_then.x(), place.y(), radius / lean_then * side_then.y()};
}

}  // namespace impinge
