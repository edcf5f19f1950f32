#include "engine/detection/continuous/plane_passage.hpp"

#include <algorithm>

#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/geometry/convex/mesh_hull.hpp"

namespace impinge {
namespace {

constexpr int kLooks = 40;            // halvings of the way: as far as a double knows it
constexpr int kFeature = 0x3fffffff;  // no corner has that number

/// Of a body in the plane's frame.
struct Lowest {
  Vec3 point;
  double depth = -INFINITY;  ///< metres below the plane
};

}  // namespace

std::optional<Passage> passage_through_plane(const Shape& shape, const SurfacePath& of_shape, const Plane& plane,
                                             const SurfacePath& of_plane, const PassageSettings& settings) {
  std::optional<MeshHull> hull;
  std::vector<PlacedConvex> solids = convex_solids(shape);
  if (const SurfaceMesh* mesh = shape.mesh()) solids.push_back({&hull.emplace(*mesh), Pose()});
  const auto lowest_at = [&](double t) {
    const Pose pose = seen_from(of_plane.pose_at(t), of_shape.pose_at(t));
    Lowest lowest;
    for (const PlacedConvex& solid : solids) {
      const Vec3 x = farthest(placed(solid, pose), -plane.normal);
      if (const double depth = plane.offset - plane.normal.dot(x); depth > lowest.depth) lowest = {x, depth};
    }
    return lowest;
  };
  const double ended = lowest_at(1.0).depth;
  if (!(ended > settings.depth)) return std::nullopt;  // nearly all
  const double began = std::max(0.0, lowest_at(0.0).depth);
  const double allowed = std::max(settings.depth, began + (settings.creep < 0.0 ? settings.depth : settings.creep));
  if (!(ended > allowed)) return std::nullopt;
  double before = 0.0, after = 1.0;
  for (int i = 0; i < kLooks && after - before > 1e-9; ++i) {
    const double half_way = 0.5 * (before + after);
    (lowest_at(half_way).depth > 0.0 ? after : before) = half_way;
  }
  const Vec3 x = lowest_at(after).point, below = x - plane.normal * (plane.normal.dot(x) - plane.offset);
  const Pose own = of_shape.pose_at(after), at = of_plane.pose_at(after);
  Passage passage;
  passage.time = before;
  passage.approach = (ended - began) / std::max(1.0 - before, 1e-9);
  passage.point_a = of_shape.pose_at(0.0).apply(own.apply_inverse(at.apply(x)));
  passage.point_b = of_plane.pose_at(0.0).apply(below);
  passage.normal = at.rotation * plane.normal;
  passage.feature = feature_key(Feature::shape, kFeature, Feature::shape, kFeature);
  return passage;
}

}  // namespace impinge
