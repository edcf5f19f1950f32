#include "engine/geometry/inside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/distance.hpp"

namespace impinge {

double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double winding_number(const Vec3& x, std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  double sum = 0.0;
  for (const Triangle& t : triangles) sum += solid_angle(vertices[t[0]] - x, vertices[t[1]] - x, vertices[t[2]] - x);
  return sum / (4.0 * M_PI);
}

double distance_to_surface(const Vec3& x, std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles)
    best = std::min(best, closest_on_triangle(x, {vertices[t[0]], vertices[t[1]], vertices[t[2]]}).squared_distance);
  return std::sqrt(best);
}

}  // namespace impinge
