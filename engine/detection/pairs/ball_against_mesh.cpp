#include "engine/detection/pairs/ball_against_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/detection/pairs/triangles_near.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr double kFlat = 1e-6;  // between planes that are one, of a cosine and of the radius

/// Where a triangle is nearest to the centre.
struct Nearest {
  SurfaceFeature feature;
  int triangle = -1;
  Vec3 point = Vec3::Zero();
  double distance_sq = std::numeric_limits<double>::infinity();
};

class BallTest {
 public:
  BallTest(ContactSink& sink, const SurfaceView& mesh, const Ball& ball)
      : sink_(sink),
        mesh_(mesh),
        ball_(ball),
        touch_(1e-9 * (sink.second().mean_edge + ball.radius) + 1e-14 * largest_coordinate(sink.second().bounds)) {}

  bool run() {
    search();
    if (nearest_.triangle < 0) return false;  // nothing within reach, and the centre is outside the mesh's bounds
    const double distance = std::sqrt(nearest_.distance_sq);
    const bool is_behind = (ball_.center - nearest_.point).dot(mesh_.normal(nearest_.feature)) < 0.0;
    if (is_behind && (distance <= touch_ || mesh_.winds_round(ball_.center))) {
      // all around a point inside are local minima; only the nearest is the way out
      add(nearest_, distance > touch_ ? Vec3((nearest_.point - ball_.center).normalized()) : touching(nearest_));
      return true;
    }
    // faces before edges before vertices: a centre right above an edge belongs to the face
    std::stable_sort(close_.begin(), close_.end(),
                     [](const Nearest& l, const Nearest& r) { return l.feature.kind > r.feature.kind; });
    if (is_behind && distance <= ball_.radius + sink_.reach()) {
      known_.push_back(nearest_);
      add(nearest_, (ball_.center - nearest_.point).normalized());
    }
    for (const Nearest& n : close_) {
      if (is_known(n) || !is_minimum(n)) continue;
      known_.push_back(n);
      add(n, outward(n));
    }
    look_ahead();
    return false;
  }

 private:
  /// Collects what lies within reach, and the nearest of all if the centre may be inside.
  void search() {
    const double limit = ball_.radius + sink_.reach(), limit_sq = limit * limit;
    const bool may_be_inside = squared_distance(sink_.second().bounds, ball_.center) == 0.0;
    for (int t : triangles_seen_from(sink_.second(), ball_.center, limit, may_be_inside)) {
      const double lower_sq = squared_distance(triangle_bounds(mesh_, t), ball_.center);
      if (lower_sq > limit_sq && !(may_be_inside && lower_sq < nearest_.distance_sq)) continue;
      const PointTriangle p = closest_on_triangle(ball_.center, mesh_.corners(t));
      const Nearest n{mesh_.feature(t, p.feature), t, p.point, p.squared_distance};
      if (n.distance_sq < nearest_.distance_sq) nearest_ = n;
      if (n.distance_sq <= limit_sq) close_.push_back(n);
    }
  }

  /// The same feature, or a place that is the same within rounding (the projection falls on an edge).
  bool is_known(const Nearest& n) const {
    return std::any_of(known_.begin(), known_.end(), [&](const Nearest& k) {
      return k.feature == n.feature || (k.point - n.point).norm() <= touch_;
    });
  }

  /// Whether no surface beside the feature is nearer, and the centre is in front of it.
  bool is_minimum(const Nearest& n) {
    const Vec3 r = ball_.center - n.point;
    if (r.dot(mesh_.normal(n.feature)) < 0.0) return false;
    if (n.feature.kind == Feature::face) return true;
    mesh_.star(n.feature, star_);
    const double slack = std::max(touch_, 1e-9 * r.norm());
    return std::all_of(star_.begin(), star_.end(), [&](const Vec3& e) { return r.dot(e) <= slack; });
  }

  /// The way out for a centre on the surface: such that the rest of its body needn't go farther, if there is one.
  Vec3 touching(const Nearest& n) {
    const Vec3 normal = mesh_.normal(n.feature);
    if (normal.dot(ball_.rest) >= 0.0) return normal;
    // of a place on a corner or an edge rounding may have made one in a face
    SurfaceFeature feature = n.feature;
    const auto is_at = [&](const Vec3& x) { return (x - ball_.center).norm() <= touch_; };
    for (int k = 0; k < 3 && feature.kind == Feature::face; ++k) {
      const MeshTopology::Edge& e = mesh_.edge(mesh_.triangle_edges(n.triangle)[k]);
      if (is_at(closest_on_segment(ball_.center, mesh_.vertex(e.v0), mesh_.vertex(e.v1)).point))
        feature = {Feature::edge, mesh_.triangle_edges(n.triangle)[k]};
    }
    for (const int v : mesh_.triangle(n.triangle))
      if (is_at(mesh_.vertex(v))) feature = {Feature::vertex, v};
    mesh_.star(feature, star_);
    const std::optional<Vec3> across = way_across(ball_.rest, star_);
    return across && across->dot(mesh_.normal(feature)) > 0.0 ? *across : normal;
  }

  Vec3 outward(const Nearest& n) {
    const double distance = std::sqrt(n.distance_sq);
    if (distance <= touch_) return touching(n);
    if (n.feature.kind == Feature::face) return mesh_.normal(n.feature);
    return (ball_.center - n.point).normalized();
  }

  /// A ball that crosses in one step what it isn't near yet: the plane of the triangle that its centre meets.
  void look_ahead() {
    const ContactQuery& query = sink_.query();
    if (!query.proximity || !(query.time_step > 0.0)) return;
    const Vec3 way =
        query.time_step * (sink_.first().velocity_at(ball_.center) - sink_.second().velocity_at(ball_.center));
    if (way.norm() <= query.activation) return;
    Aabb swept;
    swept.include(ball_.center);
    swept.include(ball_.center + way);
    double first = 1.0;
    Nearest hit;
    for (int t : triangles_near(sink_.second(), swept)) {
      if (mesh_.face_normal(t).dot(way) >= 0.0) continue;
      const std::optional<RayHit> ray = intersect_line(ball_.center, way, mesh_.corners(t), 1e-9);
      if (!ray || ray->t < 0.0 || ray->t > first || (hit.triangle >= 0 && ray->t == first)) continue;
      first = ray->t;
      hit = {{Feature::face, t}, t, ball_.center + ray->t * way, 0.0};
    }
    if (hit.triangle >= 0 && !is_known(hit) && !is_in_plane_of_known(hit)) add(hit, mesh_.face_normal(hit.triangle));
  }

  /// Whether a face that has a contact already lies in the same plane: one row holds the ball off both.
  bool is_in_plane_of_known(const Nearest& n) const {
    const Vec3 normal = mesh_.face_normal(n.triangle);
    return std::any_of(known_.begin(), known_.end(), [&](const Nearest& k) {
      return k.feature.kind == Feature::face && mesh_.face_normal(k.triangle).dot(normal) > 1.0 - kFlat &&
             std::abs(normal.dot(n.point - k.point)) <= kFlat * ball_.radius;
    });
  }

  void add(const Nearest& n, const Vec3& normal) {
    if (normal.isZero(0.0)) return;  // a triangle without area; its neighbours hold the same points
    Candidate c;
    c.normal = normal;
    c.point_first = ball_.center - ball_.radius * normal;
    c.point_second = n.point;
    c.owner = n.feature.kind == Feature::face ? NormalOwner::second : NormalOwner::neither;
    c.kind_first = ball_.kind;
    c.index_first = ball_.index;
    c.kind_second = n.feature.kind;
    c.index_second = n.feature.index;
    c.triangle_second = n.triangle;
    sink_.add_new(c);
  }

  ContactSink& sink_;
  const SurfaceView& mesh_;
  const Ball& ball_;
  const double touch_;  ///< metres: closer, the direction to the surface is rounding
  Nearest nearest_;
  std::vector<Nearest> close_, known_;
  std::vector<Vec3> star_;
};

}  // namespace

std::optional<Vec3> way_across(const Vec3& axis, std::span<const Vec3> star) {
  constexpr double kRounding = 1e-9, kFall = 1e-5;  // of directions
  const Vec3 u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
  std::vector<double> angles;
  for (const Vec3& e : star) {
    const double x = e.dot(u), y = e.dot(v);
    if (std::hypot(x, y) > kRounding) angles.push_back(std::atan2(y, x));
  }
  if (angles.empty()) return std::nullopt;
  std::sort(angles.begin(), angles.end());
  double widest = -1.0, middle = 0.0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2.0 * M_PI, width = next - angles[i];
    if (width > widest) widest = width, middle = 0.5 * (angles[i] + next);
  }
  if (widest < M_PI - 2.0 * kRounding) return std::nullopt;
  const Vec3 way = std::cos(middle) * u + std::sin(middle) * v;
  const auto falls = [&](const Vec3& e) { return e.dot(way) < -kFall; };
  return std::any_of(star.begin(), star.end(), falls) ? std::optional(way) : std::nullopt;
}

bool add_ball_contacts(ContactSink& sink, const SurfaceView& mesh, const Ball& ball) {
  return BallTest(sink, mesh, ball).run();
}

std::optional<Collision> way_out(const ContactSink& sink, const SurfaceView& mesh, const Vec3& x) {
  ContactQuery at_once = sink.query();
  at_once.activation = 0.0;
  at_once.time_step = 0.0;
  const Collider local[2] = {sink.first(), sink.second()};
  std::vector<Collision> out;
  ContactSink only(local, {BodyIndex(0), BodyIndex(1), 0.0}, false, at_once, out);
  if (!add_ball_contacts(only, mesh, {x, 0.0, Feature::shape, 0}) || out.empty()) return std::nullopt;
  return out.front();
}

}  // namespace impinge
