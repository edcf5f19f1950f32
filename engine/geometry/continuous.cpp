#include "engine/geometry/continuous.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "engine/geometry/distance.hpp"
#include "engine/geometry/exact_separation.hpp"

namespace impinge {
namespace {

constexpr double kRounding = 0x1.0p-52;

/// A part of [0, 1] whose ends are whole multiples of 2^-depth: bisection then never rounds.
struct SubBox {
  std::uint64_t index = 0;
  int depth = 0;
  double low() const { return std::ldexp(static_cast<double>(index), -depth); }
  double high() const { return std::ldexp(static_cast<double>(index + 1), -depth); }
  double width() const { return std::ldexp(1.0, -depth); }
  SubBox half(int which) const { return {2 * index + which, depth + 1}; }
};

constexpr int kDeepest = 50;  // beyond this the ends of a part are no longer exact doubles apart

/// t, and the two coordinates on the features.
struct Box {
  std::array<SubBox, 3> part;
};

struct Later {  // the earliest on top; of those that start together the finest, which decides soonest
  bool operator()(const Box& a, const Box& b) const {
    const double ta = a.part[0].low(), tb = b.part[0].low();
    if (ta != tb) return ta > tb;
    const auto depth = [](const Box& x) { return x.part[0].depth + x.part[1].depth + x.part[2].depth; };
    return depth(a) < depth(b);
  }
};

/// The vector between the two points that t, u, v name. It is linear in each of the three, so over a box each component
/// lies between its values at the eight corners.
struct VertexFace {
  static constexpr bool kTriangle = true;
  static Vec3 between(const std::array<Vec3, 4>& p, double u, double v) {
    return (p[0] - p[1]) - (u * (p[2] - p[1]) + v * (p[3] - p[1]));
  }
  static Vec3 normal(const std::array<Vec3, 4>& p) { return (p[2] - p[1]).cross(p[3] - p[1]); }
  static bool are_apart(const MovingCorners& corners) { return is_vertex_kept_off_face(corners); }
};
struct EdgeEdge {
  static constexpr bool kTriangle = false;
  static Vec3 between(const std::array<Vec3, 4>& p, double u, double v) {
    return (p[0] - p[2]) + (u * (p[1] - p[0]) - v * (p[3] - p[2]));
  }
  static Vec3 normal(const std::array<Vec3, 4>& p) { return (p[1] - p[0]).cross(p[3] - p[2]); }
  static bool are_apart(const MovingCorners& corners) { return are_edges_kept_apart(corners); }
};

/// The corners about their common middle: large coordinates cost no accuracy beyond their own rounding.
struct LocalCorners {
  MovingCorners corners;
  double rounding = 0.0;  ///< bound on the error of `between` at any (t, u, v), metres

  explicit LocalCorners(const MovingCorners& given) : corners(given) {
    Vec3 low = given.start[0], high = low;
    for (const auto* set : {&given.start, &given.end})
      for (const Vec3& x : *set) low = low.cwiseMin(x), high = high.cwiseMax(x);
    const Vec3 middle = 0.5 * (low + high);
    double far = 0.0, size = 0.0;
    for (auto* set : {&corners.start, &corners.end})
      for (Vec3& x : *set) {
        far = std::max(far, x.cwiseAbs().maxCoeff());
        x -= middle;
        size = std::max(size, x.cwiseAbs().maxCoeff());
      }
    // a shift rounds each coordinate once; `at` and `between` make some thirty operations on values up to 4 · size
    rounding = 2.0 * kRounding * far + 64.0 * kRounding * size;
  }

  std::array<Vec3, 4> at(double t) const {
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = corners.start[k] + t * (corners.end[k] - corners.start[k]);
    return p;
  }
};

/// How far `between` moves, at most, while each of t, u, v goes through all of [0, 1] (the triangle: u + v <= 1 holds
/// over what is kept, but boxes reach beyond it): the side of its range that each coordinate makes, metres.
template <class Pair>
Vec3 reach(const LocalCorners& local) {
  const auto& s = local.corners.start;
  const auto& e = local.corners.end;
  const auto most = [](const Vec3& a, const Vec3& b) {
    return std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  };
  double time = 0.0;
  for (double u : {0.0, 1.0})
    for (double v : {0.0, 1.0})
      time = std::max(time, (Pair::between(e, u, v) - Pair::between(s, u, v)).cwiseAbs().maxCoeff());
  if (Pair::kTriangle) return {time, most(s[2] - s[1], e[2] - e[1]), most(s[3] - s[1], e[3] - e[1])};
  return {time, most(s[1] - s[0], e[1] - e[0]), most(s[3] - s[2], e[3] - e[2])};
}

/// Whether all that lies between the ends of a box is farther than the margin on one side of a plane through zero.
bool are_beyond(const Vec3& normal, const std::array<Vec3, 8>& ends, double margin) {
  double low = INFINITY, high = -INFINITY, size = 0.0;
  for (const Vec3& d : ends) {
    const double height = normal.dot(d);
    low = std::min(low, height), high = std::max(high, height);
    size = std::max(size, d.cwiseAbs().maxCoeff());
  }
  const double least = (margin + 16.0 * kRounding * size) * (1.0 + 8.0 * kRounding) * normal.norm();
  return low > least || high < -least;
}

/// Features that may pass within rounding of each other would be bisected to the end and then called in contact.
constexpr int kBoxesBeforeExact = 512;

template <class Pair>
std::optional<Impact> bisect(const MovingCorners& given, const ContinuousSettings& settings) {
  const LocalCorners local(given);
  const Vec3 side = reach<Pair>(local);
  const double margin = settings.separation + 2.0 * local.rounding;
  std::priority_queue<Box, std::vector<Box>, Later> boxes;
  boxes.push({});
  bool is_told_exactly = false;
  for (int looked = 1; !boxes.empty(); ++looked) {
    const Box box = boxes.top();
    boxes.pop();
    const auto& [t, u, v] = box.part;
    if (Pair::kTriangle && u.low() + v.low() > 1.0) continue;
    Vec3 low = Vec3::Constant(INFINITY), high = -low;
    std::array<Vec3, 8> ends;
    std::size_t next = 0;
    for (double time : {t.low(), t.high()}) {
      const std::array<Vec3, 4> p = local.at(time);
      for (double a : {u.low(), u.high()})
        for (double b : {v.low(), v.high()}) {
          const Vec3 d = ends[next++] = Pair::between(p, a, b);
          low = low.cwiseMin(d), high = high.cwiseMax(d);
        }
    }
    const Vec3 gap = low.cwiseMax(-high).cwiseMax(0.0);  // from zero to the range, by axis
    if (gap.squaredNorm() > margin * margin * (1.0 + 8.0 * kRounding)) continue;
    // features that slide along each other are told apart by a slanted plane long before boxes do
    if (are_beyond(Pair::normal(local.at(t.low())), ends, margin)) continue;
    if (are_beyond(std::accumulate(ends.begin(), ends.end(), Vec3(Vec3::Zero())), ends, margin)) continue;
    const Vec2 place(0.5 * (u.low() + u.high()), 0.5 * (v.low() + v.high()));
    // √3: of a range this wide in each axis the farthest point
    const bool is_found = std::sqrt(3.0) * (high - low).maxCoeff() <= settings.tolerance;
    if (settings.separation == 0.0 && !is_told_exactly && (is_found || looked > kBoxesBeforeExact)) {
      is_told_exactly = true;
      if (Pair::are_apart(given)) return std::nullopt;
    }
    if (is_found) return Impact{t.low(), place, true};
    if (looked >= settings.max_boxes) return Impact{t.low(), place, false};
    const Vec3 extent(side[0] * t.width(), side[1] * u.width(), side[2] * v.width());
    int widest = -1;
    for (int k = 0; k < 3; ++k)
      if (box.part[k].depth < kDeepest && (widest < 0 || extent[k] > extent[widest])) widest = k;
    if (widest < 0) return Impact{t.low(), place, true};
    for (int which : {0, 1}) {
      Box next = box;
      next.part[widest] = box.part[widest].half(which);
      boxes.push(next);
    }
  }
  return std::nullopt;
}

/// Steps by what the distance allows: no point of the features moves faster against the other than `speed`.
template <class Distance>
std::optional<Impact> advance(const MovingCorners& given, const ContinuousSettings& settings, int first_group,
                              const Distance& distance) {
  const LocalCorners local(given);
  // what all four corners share moves nothing against anything
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < 4; ++k) mean += 0.25 * (local.corners.end[k] - local.corners.start[k]);
  double speed[2] = {0.0, 0.0};
  for (int k = 0; k < 4; ++k) {
    double& of = speed[k < first_group ? 0 : 1];
    of = std::max(of, (local.corners.end[k] - local.corners.start[k] - mean).norm());
  }
  const double most = speed[0] + speed[1];
  constexpr int kMostSteps = 100'000;
  double t = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    Vec2 place;
    const double d = distance(local.at(t), place) - 2.0 * local.rounding;
    const double left = d - settings.separation;
    if (left <= settings.tolerance) return Impact{t, place, true};
    if (left > most * (1.0 - t)) return std::nullopt;
    t += 0.9 * left / most;  // a full step would end in the contact itself
  }
  Vec2 place;
  distance(local.at(t), place);
  return Impact{t, place, false};
}

}  // namespace

std::optional<Impact> vertex_face_impact(const MovingCorners& corners, const ContinuousSettings& settings) {
  return bisect<VertexFace>(corners, settings);
}

std::optional<Impact> edge_edge_impact(const MovingCorners& corners, const ContinuousSettings& settings) {
  return bisect<EdgeEdge>(corners, settings);
}

std::optional<Impact> vertex_face_advancement(const MovingCorners& corners, const ContinuousSettings& settings) {
  return advance(corners, settings, 1, [](const std::array<Vec3, 4>& p, Vec2& place) {
    const PointTriangle closest = closest_on_triangle(p[0], {p[1], p[2], p[3]});
    const Vec3 e0 = p[2] - p[1], e1 = p[3] - p[1], x = closest.point - p[1];
    const double d00 = e0.dot(e0), d01 = e0.dot(e1), d11 = e1.dot(e1), det = d00 * d11 - d01 * d01;
    if (det > 0.0) place = Vec2(d11 * x.dot(e0) - d01 * x.dot(e1), d00 * x.dot(e1) - d01 * x.dot(e0)) / det;
    return std::sqrt(closest.squared_distance);
  });
}

std::optional<Impact> edge_edge_advancement(const MovingCorners& corners, const ContinuousSettings& settings) {
  return advance(corners, settings, 2, [](const std::array<Vec3, 4>& p, Vec2& place) {
    const SegmentSegment closest = closest_between_segments(p[0], p[1], p[2], p[3]);
    place = {closest.s, closest.t};
    return std::sqrt(closest.squared_distance);
  });
}

}  // namespace impinge
