#include "engine/detection/continuous/round_path.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr int kMostPieces = 256;  // of the path: beyond, a search is no dearer

bool is_nearer(const Vec3& p, const Vec3& q, const TriangleCorners& t, double limit_sq) {
  if (closest_on_triangle(p, t).squared_distance < limit_sq) return true;
  if (p == q) return false;
  if (closest_on_triangle(q, t).squared_distance < limit_sq) return true;
  for (int k = 0; k < 3; ++k)
    if (closest_between_segments(p, q, t[k], t[(k + 1) % 3]).squared_distance < limit_sq) return true;
  const std::optional<RayHit> hit = intersect_line(p, q - p, t);
  return hit && hit->t >= 0.0 && hit->t <= 1.0;
}

/// Whether the segment comes nearer than `limit` to a triangle; all in the surface's frame.
bool is_nearer(const Vec3& p, const Vec3& q, const SurfaceMesh& surface, double limit) {
  const BoxTree& tree = surface.tree();
  const Aabb box = Aabb{p.cwiseMin(q), p.cwiseMax(q)}.inflated(limit);
  bool found = false;
  const auto meets = [&](int n) {
    const Aabb& node = tree.nodes()[static_cast<std::size_t>(n)].box;
    if (found || !overlap(node, box)) return false;
    const double reach = limit + 0.5 * node.extent().norm();  // of the ball round it
    return closest_on_segment(node.center(), p, q).squared_distance < reach * reach;
  };
  tree.search(meets, [&](int t) {
    const Triangle& corners = surface.mesh.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int k) { return surface.mesh.vertices[static_cast<std::size_t>(corners[k])]; };
    found = found || is_nearer(p, q, {at(0), at(1), at(2)}, limit * limit);
  });
  return found;
}

/// A body on its path, and which of its points are followed: all of its surface, or the ends of a round body's core, which
/// spins about its own axis as it likes.
struct Mover {
  const SurfacePath& path;
  const RoundCore* core = nullptr;

  double way(double t0, double t1) const {
    if (core == nullptr) return path.travel(t0, t1);
    const double of_centre = (path.pose_at(t1).position - path.pose_at(t0).position).norm();
    if (is_ball()) return of_centre;
    const Vec3 turn = turn_of(t0, t1);
    return of_centre + turn.norm() * swing(turn, t0);
  }
  double bend(double t0, double t1) const {
    if (core == nullptr) return path.bend(t0, t1);
    if (is_ball()) return 0.0;
    const Vec3 turn = turn_of(t0, t1);
    return swing(turn, t0) * (1.0 - std::cos(0.5 * turn.norm()));
  }

 private:
  bool is_ball() const { return core->p.isZero(0.0) && core->q.isZero(0.0); }
  Vec3 turn_of(double t0, double t1) const {
    return rotation_log(path.pose_at(t1).rotation * path.pose_at(t0).rotation.transpose());
  }
  /// How far the farther end is from the axis of a turn through the body's centre, metres: neighbouring poses are joined by
  /// a screw, on which that stays as it is.
  double swing(const Vec3& turn, double t0) const {
    const double angle = turn.norm();
    if (!(angle > 0.0)) return 0.0;
    const Mat3 rotation = path.pose_at(t0).rotation;
    return std::max(turn.cross(rotation * core->p).norm(), turn.cross(rotation * core->q).norm()) / angle;
  }
};

/// Whether two things keep a distance of `radius` less `depth` all along; is_nearer(t, limit) tells at one moment. At those
/// that are looked at they keep half of `depth` more, and between them come nearer by less than that: a point that goes
/// straight by m between two places at a distance comes nearer to a triangle or a segment by m² / 8 of it at most.
template <class IsNearer>
bool stays_apart(double radius, const Mover& a, const Mover& b, double depth, const IsNearer& is_nearer) {
  const double slack = 0.5 * depth, limit = radius - depth + slack;
  if (!(limit > 0.5 * radius) || !a.path.is_rigid() || !b.path.is_rigid()) return false;
  const auto way = [&](double t0, double t1) { return a.way(t0, t1) + b.way(t0, t1); };
  const int least = std::max(a.path.pieces(), b.path.pieces());  // both are powers of two
  double whole = 0.0;
  for (int i = 0; i < least; ++i) whole += way(static_cast<double>(i) / least, (i + 1.0) / least);
  const double wanted = std::ceil(whole / (std::sqrt(4.0 * limit * slack) * least));
  if (!(wanted * least <= kMostPieces)) return false;
  const int pieces = least * std::max(1, static_cast<int>(wanted));
  for (int i = 0; i < pieces; ++i) {
    const double t0 = static_cast<double>(i) / pieces, t1 = (i + 1.0) / pieces, m = way(t0, t1);
    if (m * m / (8.0 * limit) + a.bend(t0, t1) + b.bend(t0, t1) > slack) return false;
  }
  for (int i = pieces; i >= 0; --i)  // where it ends it is the most likely to be too near
    if (is_nearer(static_cast<double>(i) / pieces, limit)) return false;
  return true;
}

}  // namespace

std::optional<RoundCore> round_core(const Shape& shape) {
  if (const auto* ball = shape.as<Sphere>()) return RoundCore{Vec3::Zero(), Vec3::Zero(), ball->radius};
  if (const auto* capsule = shape.as<Capsule>()) {
    const Vec3 end = capsule->half_length * Vec3::UnitY();
    return RoundCore{-end, end, capsule->radius};
  }
  return std::nullopt;
}

bool stays_out(const RoundCore& core, const SurfacePath& own, const SurfacePath& triangles, double depth) {
  return stays_apart(core.radius, {own, &core}, {triangles}, depth, [&](double t, double limit) {
    const Pose of_own = own.pose_at(t), of_other = triangles.pose_at(t);
    return is_nearer(of_other.apply_inverse(of_own.apply(core.p)), of_other.apply_inverse(of_own.apply(core.q)),
                     *triangles.of->surface, limit);
  });
}

bool stays_out(const RoundCore& a, const SurfacePath& of_a, const RoundCore& b, const SurfacePath& of_b, double depth) {
  return stays_apart(a.radius + b.radius, {of_a, &a}, {of_b, &b}, depth, [&](double t, double limit) {
    const Pose at_a = of_a.pose_at(t), at_b = of_b.pose_at(t);
    return closest_between_segments(at_a.apply(a.p), at_a.apply(a.q), at_b.apply(b.p), at_b.apply(b.q))
               .squared_distance < limit * limit;
  });
}

}  // namespace impinge
