#include "viewer/sweep/surface_match.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {

SurfaceMatch::SurfaceMatch(const TriangleMesh& own, const TriangleMesh& other) {
  if (own.vertices.size() == other.vertices.size() && own.triangles == other.triangles) return;
  const BoxTree tree(triangle_boxes(other.triangles, other.vertices));
  int guess = -1;
  places_.reserve(own.vertices.size());
  for (const Vec3& x : own.vertices) {
    const NearestTriangle nearest = nearest_triangle(tree, other.triangles, other.vertices, x, {}, guess);
    guess = nearest.triangle;
    if (guess < 0) return;  // there are no triangles
    const Triangle& corners = other.triangles[static_cast<std::size_t>(guess)];
    const auto corner = [&](std::size_t k) { return other.vertices[static_cast<std::size_t>(corners[k])]; };
    places_.push_back({corners, nearest_weights(x, {corner(0), corner(1), corner(2)})});
    apart_ = std::max(apart_, std::sqrt(nearest.at.squared_distance));
  }
}

std::vector<Vec3> SurfaceMatch::points(const std::vector<Vec3>& vertices) const {
  if (is_by_number()) return vertices;
  std::vector<Vec3> points;
  points.reserve(places_.size());
  for (const Place& place : places_) {
    Vec3& x = points.emplace_back(Vec3::Zero());
    for (std::size_t k = 0; k < 3; ++k)
      x += place.weights[static_cast<Eigen::Index>(k)] * vertices[static_cast<std::size_t>(place.corners[k])];
  }
  return points;
}

}  // namespace impinge
