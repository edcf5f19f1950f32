#include "engine/geometry/surface/inner_points.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {

std::vector<Vec3> inner_points(const SearchedMesh& mesh, std::size_t most) {
  constexpr double kSlack = 1e-9;  // a ray through an edge meets either triangle there
  std::vector<Vec3> points;
  const std::size_t count = mesh.triangles().size(), stride = std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = 0; i < count; i += stride) {
    const TriangleCorners own = mesh.corners(static_cast<int>(i));
    const Vec3 across = (own[1] - own[0]).cross(own[2] - own[0]), middle = (own[0] + own[1] + own[2]) / 3.0;
    if (!(across.norm() > 0.0)) continue;
    const Vec3 inward = -across.normalized();
    const double way = mesh.way_along(middle, inward, kSlack, static_cast<int>(i));
    if (std::isfinite(way)) points.push_back(middle + 0.5 * way * inward);
  }
  return points;
}

double deepest_inner_point(const SearchedMesh& mesh, std::size_t most, const Aabb& box,
                           const std::function<double(const Vec3&)>& depth) {
  double deepest = 0.0;
  for (const Vec3& x : inner_points(mesh, most))
    if (overlap(box, Aabb{x, x})) deepest = std::max(deepest, depth(x));
  return deepest;
}

}  // namespace impinge
