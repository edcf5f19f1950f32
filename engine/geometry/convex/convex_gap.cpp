#include "engine/geometry/convex/convex_gap.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/convex/expanding_polytope.hpp"
#include "engine/geometry/convex/polyhedron_axes.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

// All relative to the size of the difference (the largest |a - b| seen).
constexpr double kTie = 1e-11;         // separations closer than this are equal
constexpr double kNoDirection = 1e-9;  // nearer than this, the line between the nearest points is mostly rounding
constexpr double kNear = 1e-4;         // curved solids nearer than this are moved apart before they are looked at
constexpr double kFewPairs = 1000.0;   // of edges: up to here all separating axes cost less than a polytope
constexpr double kManyPairs = 4e6;     // beyond this they cost too much even as the last resort

class Gap {
 public:
  Gap(const PlacedConvex& a, const PlacedConvex& b) : d_(a, b) {}

  ConvexGap run(double reach) {
    GjkResult g = gjk(d_, reach + d_.rounding());
    size_ = g.size;
    ConvexGap result;
    if (g.apart && g.distance > reach + d_.rounding()) {
      result.is_within_reach = false;
      return result;
    }
    if (d_.is_polyhedral())
      polyhedra(g);
    else
      curved(g);
    const double ra = d_.a().set->rounding(), rb = d_.b().set->rounding();
    result.gap = gap_ - ra - rb;
    result.normal = normal_;
    result.point_a = d_.to_world(point_a_ - ra * normal_);
    result.point_b = d_.to_world(point_b_ + rb * normal_);
    return result;
  }

 private:
  /// Nearest points of the cores from the corners of GJK's last simplex.
  void take_points(const GjkResult& g) {
    TriangleCorners a, b;
    for (int k = 0; k < 3; ++k) a[k] = g.point[std::min(k, g.count - 1)].a, b[k] = g.point[std::min(k, g.count - 1)].b;
    const TriangleTriangle closest = closest_features(a, b);
    point_a_ = closest.point0;
    point_b_ = closest.point1;
  }

  /// Nearest points along a direction in which the solids may overlap: of a moved out along it.
  void take_points_along(const Vec3& direction, double separation) {
    const double away = std::max(0.0, -separation) + 0.01 * size_;
    d_.set_shift(away * direction);
    const GjkResult g = gjk(d_);
    d_.set_shift(Vec3::Zero());
    // closest_features knows nothing of the shift
    MinkowskiPoint corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = g.point[std::min(k, g.count - 1)];
    TriangleCorners a, b;
    for (int k = 0; k < 3; ++k) a[k] = corner[k].a + away * direction, b[k] = corner[k].b;
    const TriangleTriangle closest = closest_features(a, b);
    point_a_ = closest.point0 - away * direction;
    point_b_ = closest.point1;
    moved_direction_ = closest.point0 - closest.point1;
  }

  void polyhedra(const GjkResult& g) {
    if (g.apart) {
      take_points(g);
      const Vec3 between = point_a_ - point_b_;
      gap_ = between.norm();
      if (gap_ > kNoDirection * size_) {
        normal_ = between / gap_;
        const SeparatingAxis axis = nearby_axis(d_, std::span(g.point).first(std::min(g.count, 3)), normal_);
        if (axis.separation >= gap_ - kTie * size_) normal_ = axis.direction;
        return;
      }
    }
    const SeparatingAxis axis = overlap_axis(g);
    if (!g.apart || axis.separation <= 0.0) gap_ = axis.separation;
    normal_ = axis.direction;
    take_points_along(normal_, axis.separation);
  }

  SeparatingAxis overlap_axis(const GjkResult& g) {
    const double work = axis_work(d_);
    if (work <= kFewPairs) return best_axis(d_, kTie * size_);
    const PolytopeResult p = expand_polytope(d_, g, 1e-14, 1000);
    SeparatingAxis best{p.direction, -p.depth};
    const SeparatingAxis axis = nearby_axis(d_, p.face, p.direction);
    if (axis.separation >= best.separation - kTie * size_) best = axis;
    if (p.has_volume && -best.separation - p.least <= kTie * size_) return best;
    if (work > kManyPairs) return best;
    return best_axis(d_, kTie * size_);
  }

  void curved(const GjkResult& g) {
    if (g.apart && g.distance > kNear * size_) {
      take_points(g);
      const Vec3 between = point_a_ - point_b_;
      gap_ = between.norm();
      normal_ = between / gap_;
    } else if (g.apart && g.distance > kNoDirection * size_) {
      normal_ = g.nearest / g.distance;
      gap_ = d_.separation(normal_);
      refine();
    } else {
      const PolytopeResult p = expand_polytope(d_, g, 1e-9, 300);
      normal_ = p.direction;
      gap_ = -p.depth;
      refine();
    }
    snap();
    if (gap_ <= kNear * size_) take_points_along(normal_, gap_);
  }

  /// Moves a out along the direction until the two are well apart: the direction between the nearest points there is
  /// right to many digits, and at its fixed point it is that of the gap. The farther out, the slower it gets there.
  void refine() {
    for (int step = 0; step < 12; ++step) {
      take_points_along(normal_, gap_);
      const Vec3 direction = moved_direction_.normalized();
      const double separation = d_.separation(direction);
      if (!(separation > gap_)) return;
      const bool is_last = separation - gap_ <= 1e-15 * size_;
      gap_ = separation;
      normal_ = direction;
      if (is_last) return;
    }
  }

  /// A flat part of either surface whose normal is as good gives the exact direction.
  void snap() {
    const auto offer = [&](const Vec3& direction) {
      if (direction.dot(normal_) < kNearlyFacing) return;
      const double separation = d_.separation(direction);
      if (separation < gap_ - kTie * size_) return;
      gap_ = std::max(gap_, separation);
      normal_ = direction;
    };
    const Pose &a = d_.a().pose, &b = d_.b().pose;
    const ContactFace face_a = d_.a().set->facing(a.rotation.transpose() * -normal_),
                      face_b = d_.b().set->facing(b.rotation.transpose() * normal_);
    if (face_b.count > 2) offer(b.rotation * face_b.normal);
    if (face_a.count > 2) offer(-(a.rotation * face_a.normal));
  }

  MinkowskiDifference d_;
  double size_ = 0.0, gap_ = 0.0;
  Vec3 normal_ = Vec3::UnitY(), point_a_ = Vec3::Zero(), point_b_ = Vec3::Zero();
  Vec3 moved_direction_ = Vec3::UnitY();
};

}  // namespace

ConvexGap convex_gap(const PlacedConvex& a, const PlacedConvex& b, double reach) { return Gap(a, b).run(reach); }

}  // namespace impinge
