#include "engine/detection/continuous/solid_passages.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/interrupt.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/continuous/convex_solids.hpp"
#include "engine/detection/continuous/moving_solid.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/convex/convex_gap.hpp"
#include "engine/geometry/convex/convex_triangle.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr int kMostGaps = 1 << 14;      // that are worked out: beyond, a search of triangles is no dearer
constexpr int kMostHalvings = 40;       // of a path's piece
constexpr double kWindow = 1e-3;        // of the sub-step: what is met so soon after the first is told with it
constexpr double kSoon = 100.0;         // of a way that is as good as none: the same
constexpr double kFirstStep = 1e-6;     // of the sub-step: back from where it is too deep
constexpr std::size_t kMostPlanes = 8;  // of an interval
constexpr double kRolls = 0.5;          // of its distance from the centre: how far the place at which it rolls may get
constexpr double kSameNormal = 1e-6;    // the sine of an angle that is none
constexpr int kBisections = 30;         // for the moment at which the two touch

/// One solid of a body against the triangles, as their body sees it.
class SolidSearch {
 public:
  SolidSearch(const PlacedConvex& solid, int number, const Shape& shape, bool is_round, const SurfacePath& own,
              const SurfacePath& triangles, const PassageSettings& settings)
      : solid_(solid),
        number_(number),
        size_(shape.bounding_radius()),
        radius_(shape.as<Sphere>() != nullptr ? 0.0 : size_),
        is_round_(is_round),
        own_(own),
        other_(triangles),
        surface_(*triangles.of->surface),
        settings_(settings),
        creep_(settings.creep < 0.0 ? settings.depth : settings.creep),
        between_(std::max(settings.reach, settings.graze)) {}

  /// Not one that begins after `best`, which is brought down to the first. False: too many looks.
  bool run(double& best, std::vector<Passage>& passages) {
    const int pieces = std::max(own_.pieces(), other_.pieces());  // both are powers of two
    for (int i = 0; i < pieces && !is_over_; ++i) {
      const double t0 = static_cast<double>(i) / pieces;
      if (t0 > best + kWindow) break;
      begin({*this, t0, (i + 1.0) / pieces}, kMostHalvings);
    }
    if (left_ < 0) return false;
    for (const Passage& p : found_) best = std::min(best, p.time);
    passages.insert(passages.end(), found_.begin(), found_.end());
    return true;
  }

 private:
  struct Interval {
    Interval(const SolidSearch& of, double from, double to)
        : t0(from),
          t1(to),
          own{&of.solid_, of.own_.pose_at(t0), of.own_.pose_at(t1), of.radius_, of.is_round_},
          other{nullptr, of.other_.pose_at(t0), of.other_.pose_at(t1), 0.0},
          at0(placed(of.solid_, seen_from(other.first, own.first))),
          at1(placed(of.solid_, seen_from(other.last, own.last))),
          bend(bend_between(own, other)) {
      const double from_other = std::max((own.first.position - other.first.position).norm(),
                                         (own.last.position - other.last.position).norm());
      ways = (own.way() - other.way()).norm() + other.turn().norm() * from_other + own.swing_beside(other) * of.radius_;
    }
    double t0, t1;
    MovingSolid own, other;
    PlacedConvex at0, at1;  // as the triangles' body sees it
    double bend;            // how far its points' places may be off the straight line between, metres
    double ways = 0.0;      // of its points at most, metres
  };

  PlacedConvex at(double t) const { return placed(solid_, seen_from(other_.pose_at(t), own_.pose_at(t))); }

  /// A way longer than the solid is looked at in parts: the box of the whole would hold too much.
  void begin(const Interval& piece, int halvings) {
    if (is_over_) return;
    if (piece.ways > size_ && halvings > 0) {
      const double half_way = 0.5 * (piece.t0 + piece.t1);
      begin({*this, piece.t0, half_way}, halvings - 1);
      begin({*this, half_way, piece.t1}, halvings - 1);
      return;
    }
    const Aabb box = box_of_piece(piece.own, piece.other);
    const BoxTree& tree = surface_.tree();
    near_.clear();
    tree.search([&](int n) { return overlap(tree.nodes()[static_cast<std::size_t>(n)].box, box); },
                [&](int t) { near_.push_back(t); });
    if (!near_.empty()) look(piece, near_, {}, halvings);
  }

  /// A plane that may stand between: its normal points to the solid, which is so far along it when an interval begins and
  /// when it ends, metres.
  struct Plane {
    Plane(const Interval& of, const Vec3& unit)
        : normal(unit), first(unit.dot(farthest(of.at0, -unit))), last(unit.dot(farthest(of.at1, -unit))) {}
    Vec3 normal;
    double first, last;
  };

  /// What the interval has, halved until every triangle is known to be clear, or nothing moves any more. `normals`: of planes
  /// that stood between before.
  void look(const Interval& interval, const std::vector<int>& triangles, std::vector<Vec3> normals, int halvings) {
    poll_();
    const double half_way = 0.5 * (interval.t0 + interval.t1);
    Passed now{interval, interval.t1 == 1.0 ? interval.at1 : at(half_way), {}};
    for (const Vec3& n : normals) now.planes.emplace_back(interval, n);
    std::vector<int> left;
    for (const int t : triangles)
      if (!is_clear(now, t)) left.push_back(t);
    if (left.empty() || is_over_) return;
    if (interval.ways <= settings_.reach || halvings == 0) return judge(interval, left);
    normals.clear();
    for (const Plane& p : now.planes) normals.push_back(p.normal);
    look({*this, interval.t0, half_way}, left, normals, halvings - 1);
    if (!is_over_) look({*this, half_way, interval.t1}, left, normals, halvings - 1);
  }

  /// An interval that is looked at, and the solid at the moment of it at which gaps are worked out.
  struct Passed {
    const Interval& interval;
    PlacedConvex seen;
    std::vector<Plane> planes;
    void keep(const Plane& plane) {
      if (planes.size() == kMostPlanes) planes.erase(planes.begin());
      planes.push_back(plane);
    }
  };

  /// Whether a plane that goes along with the triangle has all of the solid beyond it. Points on straight lines are below a plane
  /// most where they start or end; on the way it may be as deep as paths may bend, and at the end of it all no deeper
  /// than it may.
  bool is_beyond(const Plane& plane, const Interval& interval, const TriangleCorners& x, double depth) const {
    const double straight = interval.bend <= between_ ? 0.0 : interval.bend;
    const double stands = std::max({plane.normal.dot(x[0]), plane.normal.dot(x[1]), plane.normal.dot(x[2])}) + straight;
    const double between = std::max(depth, between_);
    return plane.first >= stands - between && plane.last >= stands - (interval.t1 == 1.0 ? depth : between);
  }

  bool is_clear(Passed& now, int t) {
    const ConvexTriangle triangle(surface_.mesh, t);
    const TriangleCorners& x = triangle.corners();
    const auto any_beyond = [&](double depth) {
      return std::any_of(now.planes.rbegin(), now.planes.rend(),
                         [&](const Plane& p) { return is_beyond(p, now.interval, x, depth); });
    };
    if (any_beyond(settings_.depth)) return true;
    // most stand before the one side of it or the other
    const Vec3 across = (x[1] - x[0]).cross(x[2] - x[0]);
    const double area = across.norm();
    std::optional<Plane> own;
    if (area > 0.0) {
      own.emplace(now.interval, (across.dot(now.seen.pose.position - x[0]) >= 0.0 ? 1.0 : -1.0) / area * across);
      if (is_beyond(*own, now.interval, x, settings_.depth)) return now.keep(*own), true;
    }
    if (--left_ < 0) return is_over_ = true;
    const ConvexGap gap = convex_gap(now.seen, {&triangle, Pose()}, now.interval.ways);
    if (!gap.is_within_reach) return true;
    const Plane plane(now.interval, gap.normal);
    now.keep(plane);
    if (is_beyond(plane, now.interval, x, settings_.depth)) return true;
    const double allowed = allowed_in(t, triangle);
    return allowed > settings_.depth && (any_beyond(allowed) || (own && is_beyond(*own, now.interval, x, allowed)));
  }

  /// How deep the solid may be in a triangle that it begins in, metres: a little deeper.
  double allowed_in(int t, const ConvexTriangle& triangle) {
    const auto [known, is_new] = allowed_.try_emplace(t, settings_.depth);
    if (is_new && --left_ >= 0) {
      const ConvexGap first = convex_gap(at(0.0), {&triangle, Pose()}, 0.0);
      if (first.is_within_reach) known->second = std::max(settings_.depth, creep_ - first.gap);
    }
    return known->second;
  }

  double gap_at(double t, const ConvexTriangle& triangle) {
    --left_;
    return convex_gap(at(t), {&triangle, Pose()}).gap;
  }

  /// Those of the triangles in which it is too deep when the interval ends. Then it is the first moment, and what is as deep
  /// soon after belongs to it.
  void judge(const Interval& interval, const std::vector<int>& triangles) {
    const auto is_deep = [&](int t, double when) {
      const ConvexTriangle triangle(surface_.mesh, t);
      const double allowed = allowed_in(t, triangle);
      return gap_at(when, triangle) < -(when == 1.0 ? allowed : std::max(allowed, settings_.graze));
    };
    for (const int t : triangles)
      if (is_deep(t, interval.t1)) add(t, interval.t1);
    if (found_.empty()) return;
    is_over_ = true;
    const double soon = std::min(1.0, interval.t1 + std::min(kWindow, kSoon * (interval.t1 - interval.t0)));
    const Interval until(*this, interval.t0, soon);
    Passed now{until, until.at1, {}};
    for (const int t : near_)
      if (!is_clear(now, t) && is_deep(t, soon)) add(t, soon);
  }

  /// Of a triangle in which it is too deep.
  void add(int t, double when) {
    const ConvexTriangle triangle(surface_.mesh, t);
    double before = when, after = when, first = gap_at(before, triangle);
    for (double step = kFirstStep; first <= 0.0 && before > 0.0; step *= 2.0)
      after = before, before = std::max(0.0, when - step), first = gap_at(before, triangle);
    for (int i = 0; i < kBisections && first > 0.0; ++i) {
      const double middle = 0.5 * (before + after), now = gap_at(middle, triangle);
      if (now > 0.0)
        before = middle, first = now;
      else
        after = middle;
    }
    const ConvexGap then = convex_gap(at(when), {&triangle, Pose()});
    const double approach = std::max((first - then.gap) / std::max(when - before, 1e-12), 1e-300);
    for (const Touch& touch : touches(then, when, triangle.corners())) {
      Passage p = passage_of(t, triangle.corners(), when, then.normal, touch);
      p.time = before;
      p.approach = approach;
      const auto is_same = [&](const Passage& known) { return known.feature == p.feature; };
      if (std::none_of(found_.begin(), found_.end(), is_same)) found_.push_back(p);
    }
  }

  /// A place where it touches a triangle, as that one's body sees it.
  struct Touch {
    Vec3 point_a, point_b;
    int end = 0;  // of a line: from 1 on; else 0
  };

  /// Of a line that lies along a face its ends over it: one of them alone would turn it.
  std::vector<Touch> touches(const ConvexGap& then, double t, const TriangleCorners& face) const {
    std::vector<Touch> ends;
    if (is_round_ && is_normal_to(then.normal, face)) {
      const PlacedConvex solid = at(t);
      const ContactFace line = solid_.set->facing(solid.pose.rotation.transpose() * -then.normal);
      for (int k = 0; k < line.count && line.count == 2; ++k) {
        const Vec3 x = solid.pose.apply(line.point[static_cast<std::size_t>(k)]);
        const double gap = then.normal.dot(x - face[0]);
        const Vec3 on = x - gap * then.normal;
        const TriangleFeature f = closest_on_triangle(on, face).feature;
        if (!is_corner(f) && !is_edge(f) && gap - then.gap <= settings_.depth) ends.push_back({x, on, k + 1});
      }
    }
    if (ends.empty()) ends.push_back({then.point_a, then.point_b});
    return ends;
  }

  Passage passage_of(int t, const TriangleCorners& face, double when, const Vec3& normal, const Touch& touch) const {
    Passage p;
    p.triangle_b = TriangleIndex(t);
    p.normal = other_.pose_at(when).rotation * normal;
    p.point_a = own_.pose_at(0.0).apply(own_.pose_at(when).apply_inverse(other_.pose_at(when).apply(touch.point_a)));
    p.point_b = other_.pose_at(0.0).apply(touch.point_b);
    const TriangleFeature f = closest_on_triangle(touch.point_b, face).feature;
    const auto at = static_cast<std::size_t>(t);
    Feature kind = Feature::face, own = Feature::vertex;
    int index = t;
    if (is_corner(f)) kind = Feature::vertex, index = surface_.mesh.triangles[at][feature_number(f)];
    if (is_edge(f)) kind = Feature::edge, index = surface_.topology.triangle_edges[at][feature_number(f)];
    if (kind == Feature::face && is_normal_to(normal, face))
      if (const auto rolls = rolling_from(when, normal, touch.point_a)) {
        // its normal turns along with the face; behind the plane of one that it comes to over a ridge it isn't in that
        const Vec3 face_now = other_.pose_at(0.0).rotation * normal;
        const double gap = face_now.dot(*rolls - p.point_b);
        if (gap >= -settings_.depth) {
          p.point_a = *rolls, p.point_b = *rolls - gap * face_now, p.normal = face_now;
          own = Feature::shape;
        }
      }
    p.feature = feature_key(own, number_ + touch.end, kind, index);
    return p;
  }

  static bool is_normal_to(const Vec3& normal, const TriangleCorners& face) {
    const Vec3 across = (face[1] - face[0]).cross(face[2] - face[0]);
    return normal.cross(across).norm() <= kSameNormal * across.norm();
  }

  /// Of what rolls on a face not the place that comes round counts, but the one that touches now, and moves round it. None: it
  /// doesn't roll, or it rocks, and what comes down is another end of it. `normal`, `point`: as the triangles' body sees it.
  std::optional<Vec3> rolling_from(double t, const Vec3& normal, const Vec3& point) const {
    if (!is_round_) return std::nullopt;
    const Pose other = other_.pose_at(t);
    const PlacedConvex solid = placed(solid_, own_.pose_at(t)), first = placed(solid_, own_.pose_at(0.0));
    const Vec3 x = other.apply(point), place = solid.pose.apply_inverse(x), faced = other.rotation * -normal,
               faced_first = other_.pose_at(0.0).rotation * -normal;
    const Vec3 rolled = solid_.set->rolled(place, solid.pose.rotation.transpose() * faced,
                                           first.pose.rotation.transpose() * faced_first);
    const Vec3 now = first.pose.apply(rolled);
    const bool is_near = (now - x).norm() <= kRolls * (x - solid.pose.position).norm(),
               rolls_on = rolls_about_y(solid.pose.rotation, first.pose.rotation);
    return rolled != place && (is_near || rolls_on) ? std::optional(now) : std::nullopt;
  }

  const PlacedConvex solid_;
  const int number_;
  const double size_, radius_;  // metres: of the body, and that its points turn about its centre
  const bool is_round_;
  const SurfacePath &own_, &other_;
  const SurfaceMesh& surface_;
  const PassageSettings settings_;
  const double creep_, between_;   // metres; the latter: how deep it may be on the way
  std::vector<int> near_;          // triangles round the part of the way that is looked at
  std::map<int, double> allowed_;  // by triangle that came too near: how deep, metres
  std::vector<Passage> found_;
  bool is_over_ = false;
  int left_ = kMostGaps;
  InterruptPoll poll_;
};

}  // namespace

std::optional<std::vector<Passage>> first_solid_passages(const Shape& solid, const SurfacePath& own,
                                                         const SurfacePath& triangles,
                                                         const PassageSettings& settings) {
  if (!own.is_rigid() || !triangles.is_rigid()) return std::nullopt;
  const std::vector<PlacedConvex> solids = convex_solids(solid);
  if (solids.empty()) return std::nullopt;
  const bool is_round = solids.size() == 1 && solids.front().set->is_round_about_y();
  std::vector<Passage> found;
  double best = 1.0;
  int number = 0;
  for (const PlacedConvex& part : solids)
    if (!SolidSearch(part, number++, solid, is_round, own, triangles, settings).run(best, found)) return std::nullopt;
  std::erase_if(found, [&](const Passage& p) { return p.time > best + kWindow; });
  std::sort(found.begin(), found.end(), [](const Passage& l, const Passage& r) { return l.feature < r.feature; });
  return found;
}

}  // namespace impinge
