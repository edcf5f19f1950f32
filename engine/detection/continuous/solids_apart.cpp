#include "engine/detection/continuous/solids_apart.hpp"

#include <algorithm>
#include <optional>

#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/detection/continuous/moving_solid.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr int kPathPieces = 64;              // of the path, as it comes
constexpr int kSolidHalvings = 5;            // of such a piece: shorter ones bend less
constexpr int kMostLooks = 64;               // at two solids: beyond, a search is no dearer
constexpr std::size_t kMostTriangles = 512;  // round a solid's way: the same
// of what a solid may overlap with a surface: with each of its triangles. A corner of more than 30 degrees that goes down
// between two of them by that depth is in both by a quarter of it and more.
constexpr double kOfTriangle = 0.25;

double reach_of(const PlacedConvex& solid, const Vec3& direction) { return direction.dot(farthest(solid, direction)); }

/// Whether the plane of this normal, from b to a, which stands at b's surface and goes along with b, has all of `a` beyond
/// it but for `depth`. Points on straight lines are below a plane most where they start or end.
bool is_beyond(const MovingSolid& a, const MovingSolid& b, const Vec3& normal_of_b, double depth) {
  const double allowed = depth - bend_between(a, b);
  if (!(allowed > 0.0)) return false;
  const double plane = reach_of(*b.solid, normal_of_b);
  const auto overlap = [&](const Pose& of_a, const Pose& of_b) {
    return plane + reach_of(placed(*a.solid, seen_from(of_b, of_a)), -normal_of_b);
  };
  return overlap(a.last, b.last) <= allowed && overlap(a.first, b.first) <= allowed;
}

/// A ball's turning moves none of its surface.
double swing_of(const Shape& shape) { return shape.as<Sphere>() != nullptr ? 0.0 : shape.bounding_radius(); }

/// Two solids and the paths of their bodies, with the radii that their points turn about these bodies' centres.
class SolidPair {
 public:
  SolidPair(double radius_a, const SurfacePath& of_a, double radius_b, const SurfacePath& of_b, double depth)
      : path_a_(of_a), path_b_(of_b), radius_a_(radius_a), radius_b_(radius_b), depth_(depth) {}

  bool stays_apart(const PlacedConvex& a, const PlacedConvex& b) {
    a_ = &a, b_ = &b, left_ = kMostLooks;
    const int pieces = std::max(path_a_.pieces(), path_b_.pieces());  // both are powers of two
    if (pieces > kPathPieces) return false;
    for (int i = pieces - 1; i >= 0; --i)  // where it ends it is the most likely to overlap
      if (!is_clear(static_cast<double>(i) / pieces, (i + 1.0) / pieces, kSolidHalvings)) return false;
    return true;
  }

 private:
  bool is_clear(double t0, double t1, int halvings) {
    if (--left_ < 0) return false;
    const double half_way = 0.5 * (t0 + t1);
    const Pose at_a = path_a_.pose_at(half_way), at_b = path_b_.pose_at(half_way);
    const MovingSolid a{a_, path_a_.pose_at(t0), path_a_.pose_at(t1), radius_a_},
        b{b_, path_b_.pose_at(t0), path_b_.pose_at(t1), radius_b_};
    const double ways = (a.way() - b.way()).norm() + a.turn().norm() * a.radius + b.turn().norm() * b.radius;
    const ConvexGap gap = convex_gap(placed(*a_, at_a), placed(*b_, at_b), ways);
    if (!gap.is_within_reach) return true;
    if (gap.gap < -depth_) return false;
    if (is_beyond(a, b, at_b.rotation.transpose() * gap.normal, depth_) ||
        is_beyond(b, a, at_a.rotation.transpose() * -gap.normal, depth_))
      return true;
    return halvings > 0 && is_clear(half_way, t1, halvings - 1) && is_clear(t0, half_way, halvings - 1);
  }

  const SurfacePath &path_a_, &path_b_;
  const double radius_a_, radius_b_, depth_;
  const PlacedConvex *a_ = nullptr, *b_ = nullptr;
  int left_ = 0;  // looks
};

/// The box that holds a solid all along its way, as the triangles' body sees it.
Aabb box_of_way(const PlacedConvex& solid, double radius, const SurfacePath& own, const SurfacePath& triangles) {
  Aabb box;
  const int pieces = std::max(own.pieces(), triangles.pieces());
  for (int i = 0; i < pieces; ++i) {
    const double t0 = static_cast<double>(i) / pieces, t1 = (i + 1.0) / pieces;
    const Aabb piece = box_of_piece({&solid, own.pose_at(t0), own.pose_at(t1), radius},
                                    {nullptr, triangles.pose_at(t0), triangles.pose_at(t1), triangles.of->radius});
    box.include(piece.min), box.include(piece.max);
  }
  return box;
}

/// Those that reach into the box; none: there are too many.
std::optional<std::vector<int>> triangles_in(const SurfaceMesh& surface, const Aabb& box) {
  const BoxTree& tree = surface.tree();
  std::vector<int> found;
  tree.search(
      [&](int n) {
        return found.size() <= kMostTriangles && overlap(tree.nodes()[static_cast<std::size_t>(n)].box, box);
      },
      [&](int t) {
        Aabb own;
        for (const int v : surface.mesh.triangles[static_cast<std::size_t>(t)])
          own.include(surface.mesh.vertices[static_cast<std::size_t>(v)]);
        if (overlap(own, box)) found.push_back(t);
      });
  if (found.size() > kMostTriangles) return std::nullopt;
  return found;
}

}  // namespace

bool stay_apart(const Shape& a, const SurfacePath& of_a, const Shape& b, const SurfacePath& of_b, double depth) {
  if (!of_a.is_rigid() || !of_b.is_rigid()) return false;
  const std::vector<PlacedConvex> solids_a = convex_solids(a), solids_b = convex_solids(b);
  if (solids_a.empty() || solids_b.empty()) return false;
  SolidPair pair(swing_of(a), of_a, swing_of(b), of_b, depth);
  return std::all_of(solids_a.begin(), solids_a.end(), [&](const PlacedConvex& own) {
    return std::all_of(solids_b.begin(), solids_b.end(),
                       [&](const PlacedConvex& other) { return pair.stays_apart(own, other); });
  });
}

bool stay_off(const Shape& solid, const SurfacePath& own, const SurfacePath& triangles, double depth) {
  if (!own.is_rigid() || !triangles.is_rigid()) return false;
  const std::vector<PlacedConvex> solids = convex_solids(solid);
  SolidPair pair(swing_of(solid), own, triangles.of->radius, triangles, kOfTriangle * depth);
  return !solids.empty() && std::all_of(solids.begin(), solids.end(), [&](const PlacedConvex& part) {
    const SurfaceMesh& surface = *triangles.of->surface;
    const auto near = triangles_in(surface, box_of_way(part, swing_of(solid), own, triangles));
    return near && std::all_of(near->begin(), near->end(), [&](int t) {
             const ConvexTriangle triangle(surface.mesh, t);
             return pair.stays_apart(part, {&triangle, Pose()});
           });
  });
}

}  // namespace impinge
