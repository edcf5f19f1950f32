// Capsule against box and capsule: the segment between the cap centres against the other shape, less the radii.
#include <algorithm>
#include <cmath>

#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

/// Capsules closer to parallel than this sine (about 3 degrees) are held at both ends of their common length.
constexpr double kAlong = 0.05;
/// Ends of two capsules closer than this part of their length lie side by side.
constexpr double kSameEnd = 1e-6;
/// As for two boxes: normals within about 14 degrees of a face's get the points above that face too.
constexpr double kFaces = 0.97;

/// Features of a capsule: cap 0, cap 1, and (kind edge) places on the cylinder.
void set_feature(Feature& kind, int& index, double t, int place) {
  kind = t <= 0.0 || t >= 1.0 ? Feature::vertex : Feature::edge;
  index = t <= 0.0 ? 0 : t >= 1.0 ? 1 : place;
}

// ---- box and capsule ----

struct BoxSegment {
  ContactSink& sink;
  OrientedBox box;  ///< the first shape
  double radius;    ///< of the second shape
  Vec3 p0, d;       ///< the segment p0 + t d, 0 <= t <= 1, in the box's axes
  double size;      ///< a length to compare rounding with

  Vec3 at(double t) const { return p0 + t * d; }

  /// Adds the contact of the capsule's point x with box point q (both in the box's axes), x by the segment's point at
  /// t; n: unit, from the box to the segment.
  void add(double t, const Vec3& x, const Vec3& q, const Vec3& n, Feature kind, int index, int place) const {
    Candidate c;
    c.normal = -(box.axes * n);
    c.point_first = box.to_world(q);
    c.point_second = box.to_world(x);
    c.owner = kind == Feature::face ? NormalOwner::first : NormalOwner::neither;
    c.kind_first = kind;
    c.index_first = index;
    set_feature(c.kind_second, c.index_second, t, place);
    sink.add_new(c);
  }

  /// The two ends of the part of the segment that lies above a face. Places between the cap centres count only when
  /// the capsule lies nearly flat (`all`: always); else it touches with a cap.
  void add_face(int axis, int side, bool all) const {
    double lo = 0.0, hi = 1.0;
    int place_lo = 0, place_hi = 0;
    for (int k = 0; k < 3; ++k) {
      if (k == axis || d[k] == 0.0) continue;
      double t0 = (-box.half[k] - p0[k]) / d[k], t1 = (box.half[k] - p0[k]) / d[k];
      int place0 = 2 * k, place1 = 2 * k + 1;
      if (t0 > t1) {
        std::swap(t0, t1);
        std::swap(place0, place1);
      }
      if (t0 > lo) lo = t0, place_lo = place0;
      if (t1 < hi) hi = t1, place_hi = place1;
    }
    if (lo > hi) return;
    Vec3 n = Vec3::Zero();
    n[axis] = side;
    for (int end = 0; end < 2; ++end) {
      const double t = end == 0 ? lo : hi;
      if (end == 1 && (hi - lo) * d.norm() <= 1e-6 * size) break;
      const bool cap = t <= 0.0 || t >= 1.0;
      if (!cap && !all && std::abs(d[axis]) > kAlong * d.norm()) continue;
      // on the cylinder the surface lies across the axis
      const Vec3 x = at(t) - radius * (cap ? n : Vec3((n - d * (n.dot(d) / d.squaredNorm())).normalized()));
      Vec3 q = x.cwiseMax(-box.half).cwiseMin(box.half);
      q[axis] = side * box.half[axis];
      add(t, x, q, n, Feature::face, 2 * axis + (side > 0 ? 1 : 0), 1 + (end == 0 ? place_lo : place_hi));
    }
  }

  /// What lies beyond the box at the segment's point t; zero inside.
  Vec3 excess(double t) const {
    const Vec3 x = at(t);
    return x - x.cwiseMax(-box.half).cwiseMin(box.half);
  }

  /// Parameter nearest to the box; the middle when an interval is. The squared distance is convex and piecewise
  /// quadratic in t, its half derivative excess·d piecewise linear between the six planes of the box's sides.
  double nearest_parameter() const {
    std::array<double, 8> breaks;
    int count = 0;
    breaks[count++] = 0.0;
    breaks[count++] = 1.0;
    for (int k = 0; k < 3; ++k)
      for (double h : {-box.half[k], box.half[k]}) {
        if (d[k] == 0.0) continue;
        const double t = (h - p0[k]) / d[k];
        if (t > 0.0 && t < 1.0) breaks[count++] = t;
      }
    for (int i = 1; i < count; ++i)
      for (int j = i; j > 0 && breaks[j] < breaks[j - 1]; --j) std::swap(breaks[j], breaks[j - 1]);
    const auto slope = [&](double t) { return excess(t).dot(d); };
    // left: where the slope stops being negative; right: where it starts being positive
    const double zero = 1e-14 * size * size;
    double left = 1.0, right = 0.0;
    const auto root = [&](double t0, double s0, double t1, double s1) { return t0 + (t1 - t0) * (s0 / (s0 - s1)); };
    double previous = slope(breaks[0]);
    if (previous >= -zero) left = 0.0;
    for (int i = 1; i < count && left == 1.0; ++i) {
      const double s = slope(breaks[i]);
      if (s >= -zero) left = s > zero ? root(breaks[i - 1], previous, breaks[i], s) : breaks[i];
      previous = s;
    }
    previous = slope(breaks[count - 1]);
    if (previous <= zero) right = 1.0;
    for (int i = count - 2; i >= 0 && right == 0.0; --i) {
      const double s = slope(breaks[i]);
      if (s <= zero) right = s < -zero ? root(breaks[i], s, breaks[i + 1], previous) : breaks[i];
      previous = s;
    }
    return std::clamp(0.5 * (left + right), 0.0, 1.0);
  }

  void add_end(int end) const {
    const double t = end;
    const Vec3 offset = excess(t);
    const double length = offset.norm();
    if (length <= 1e-12 * size) return;
    const int beyond = static_cast<int>((offset.array() != 0.0).count());
    add(t, at(t) - radius / length * offset, at(t) - offset, offset / length,
        beyond == 1   ? Feature::face
        : beyond == 2 ? Feature::edge
                      : Feature::vertex,
        region(offset), 0);
  }

  /// A number for the face, edge or corner that an excess belongs to.
  static int region(const Vec3& offset) {
    int number = 0;
    for (int k = 2; k >= 0; --k) number = 3 * number + (offset[k] > 0.0 ? 2 : offset[k] < 0.0 ? 0 : 1);
    return number;
  }

  void apart(double t, const Vec3& offset, double distance) const {
    if (distance - radius > sink.reach()) return;
    const Vec3 n = offset / distance;
    int axis = 0;
    n.cwiseAbs().maxCoeff(&axis);
    const int side = n[axis] > 0.0 ? 1 : -1;
    const int beyond = static_cast<int>((offset.array() != 0.0).count());
    if (beyond == 1) {
      add_face(axis, side, false);
      return;
    }
    if (t <= 0.0 || t >= 1.0)
      add_end(t >= 1.0 ? 1 : 0);
    else
      add(t, at(t) - radius * n, at(t) - offset, n, beyond == 2 ? Feature::edge : Feature::vertex, region(offset), 0);
    for (int end = 0; end < 2; ++end) {
      const Vec3 other = excess(end);
      if (other.norm() > 0.0 && other.normalized().dot(n) > kFaces) add_end(end);
    }
    if (std::abs(n[axis]) > kFaces) add_face(axis, side, false);
  }

  /// The segment meets the box: the direction that separates them with the least motion.
  void through() const {
    double best = -1e300;
    int axis = 0, side = 1;
    const Vec3 low = p0.cwiseMin(p0 + d), high = p0.cwiseMax(p0 + d);
    for (int k = 0; k < 3; ++k)
      for (int s : {1, -1}) {
        const double separation = (s > 0 ? low[k] : -high[k]) - box.half[k];
        if (separation > best + 1e-10 * size) {
          best = separation;
          axis = k;
          side = s;
        }
      }
    int edge_axis = -1;
    Vec3 edge_normal = Vec3::Zero();
    double best_edge = -1e300;
    for (int k = 0; k < 3; ++k) {
      const Vec3 cross = d.cross(Vec3::Unit(k));
      const double length = cross.norm();
      if (length <= 1e-5 * d.norm()) continue;
      const Vec3 n = cross / length;
      const double along = n.dot(p0), separation = std::abs(along) - n.cwiseAbs().dot(box.half);
      if (separation > best_edge + 1e-10 * size) {
        best_edge = separation;
        edge_axis = k;
        edge_normal = along < 0.0 ? Vec3(-n) : n;
      }
    }
    if (edge_axis < 0 || best_edge <= best + 1e-10 * size + 0.02 * std::abs(best)) {
      add_face(axis, side, true);
      return;
    }
    Vec3 middle = box.half.cwiseProduct(Vec3(edge_normal.array().sign().matrix()));
    middle[edge_axis] = 0.0;
    const Vec3 reach = box.half[edge_axis] * Vec3::Unit(edge_axis);
    const SegmentSegment closest = closest_between_segments(p0, p0 + d, middle - reach, middle + reach);
    add(closest.s, closest.point0 - radius * edge_normal, closest.point1, edge_normal, Feature::edge, region(middle),
        0);
  }
};

}  // namespace

void box_capsule(ContactSink& sink) {
  const OrientedBox box = world_box(sink.first());
  const WorldSegment axis = world_axis(sink.second());
  const Vec3 p0 = box.to_local(axis.p0);
  const BoxSegment test{sink,
                        box,
                        shape_of<Capsule>(sink.second()).radius,
                        p0,
                        box.to_local(axis.p1) - p0,
                        box.half.sum() + (axis.p1 - axis.p0).norm()};
  const double t = test.nearest_parameter();
  const Vec3 offset = test.excess(t);
  const double distance = offset.norm();
  if (distance > 1e-12 * test.size)
    test.apart(t, offset, distance);
  else
    test.through();
}

void capsule_capsule(ContactSink& sink) {
  const WorldSegment a = world_axis(sink.first()), b = world_axis(sink.second());
  const double radius_a = shape_of<Capsule>(sink.first()).radius, radius_b = shape_of<Capsule>(sink.second()).radius;
  const Vec3 u = a.p1 - a.p0, v = b.p1 - b.p0;
  const SegmentSegment closest = closest_between_segments(a.p0, a.p1, b.p0, b.p1);
  const double size = u.norm() + v.norm() + radius_a + radius_b;

  // where the axes meet, the normal is across both and points from the middle of b to that of a
  const Vec3 offset = closest.point0 - closest.point1;
  Vec3 normal = offset.stableNormalized();
  if (offset.norm() <= 1e-12 * size) {
    const Vec3 cross = u.cross(v);
    normal =
        cross.norm() > 1e-9 * u.norm() * v.norm() ? Vec3(cross.normalized()) : Vec3(sink.first().pose.rotation.col(0));
    if (normal.dot(sink.first().pose.position - sink.second().pose.position) < 0.0) normal = -normal;
  }
  const auto add = [&](double s, double t, const Vec3& p, const Vec3& q, const Vec3& n, int place) {
    Candidate c;
    c.normal = n;
    c.point_first = p - radius_a * n;
    c.point_second = q + radius_b * n;
    set_feature(c.kind_first, c.index_first, s, place);
    set_feature(c.kind_second, c.index_second, t, place);
    sink.add_new(c);
  };

  // nearly parallel: the ends of the common length, which are ends of either axis that lie beside the other one. Ends
  // that lie side by side are found from both capsules and have one name.
  const double sine_scale = u.norm() * v.norm();
  bool held_at_ends = false;
  if (sine_scale > 0.0 && u.cross(v).norm() < kAlong * sine_scale) {
    struct End {
      double s, t;
      Vec3 p, q;
    };
    std::array<End, 4> ends;
    int count = 0;
    const auto place = [](const Vec3& x0, const Vec3& x1, double t) {
      return t <= 0.0 ? x0 : t >= 1.0 ? x1 : Vec3(x0 + t * (x1 - x0));
    };
    for (int i = 0; i < 4; ++i) {
      const bool of_first = i < 2;
      const Vec3& end = i == 0 ? a.p0 : i == 1 ? a.p1 : i == 2 ? b.p0 : b.p1;
      const Vec3 &start = of_first ? b.p0 : a.p0, &along = of_first ? v : u;
      double t = along.dot(end - start) / along.squaredNorm();
      if (t < -kSameEnd || t > 1.0 + kSameEnd) continue;
      t = t < kSameEnd ? 0.0 : t > 1.0 - kSameEnd ? 1.0 : t;
      const double own = i % 2;
      ends[count++] = of_first ? End{own, t, end, place(b.p0, b.p1, t)} : End{t, own, place(a.p0, a.p1, t), end};
    }
    double length = 0.0, nearest = 1e300;
    for (int i = 0; i < count; ++i) {
      length = std::max(length, (ends[i].p - ends[0].p).norm());
      nearest = std::min(nearest, (ends[i].p - ends[i].q).norm());
    }
    if (length > kSameEnd * size) {
      for (int i = 0; i < count; ++i) {
        const Vec3 between = ends[i].p - ends[i].q;
        add(ends[i].s, ends[i].t, ends[i].p, ends[i].q,
            between.norm() > 1e-12 * size ? Vec3(between.normalized()) : normal, 1);
      }
      held_at_ends = nearest <= offset.norm() + 1e-9 * size;
    }
  }
  if (!held_at_ends) add(closest.s, closest.t, closest.point0, closest.point1, normal, 0);
}

}  // namespace impinge
