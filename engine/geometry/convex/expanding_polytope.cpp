#include "engine/geometry/convex/expanding_polytope.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/geometry/convex/orientation.hpp"

namespace impinge {
namespace {

struct PolytopeFacet {
  std::array<int, 3> corner;
  std::array<int, 3> neighbour;  ///< across the side from corner k to corner k + 1
  Vec3 normal = Vec3::Zero();
  double distance = 0.0;
  bool is_gone = false;
};

class Polytope {
 public:
  Polytope(const MinkowskiDifference& difference, const GjkResult& start)
      : difference_(difference), size_(start.size), points_(start.point.begin(), start.point.begin() + start.count) {}

  PolytopeResult run(double tolerance, int most_steps) {
    PolytopeResult result;
    result.depth = 1e300;
    if (!make_tetrahedron()) {
      result.has_volume = false;
      result.direction = flat_direction_;
      result.depth = result.least = -difference_.separation(flat_direction_);
      return result;
    }
    for (int step = 0; step < most_steps; ++step) {
      const int nearest = nearest_facet();
      const PolytopeFacet& facet = facets_[nearest];
      result.least = facet.distance;
      const MinkowskiPoint p = difference_.support(facet.normal);
      const double depth = facet.normal.dot(p.w);
      size_ = std::max(size_, p.w.norm());
      if (depth < result.depth) {
        result.depth = depth;
        result.direction = -facet.normal;
        for (int k = 0; k < 3; ++k) result.face[k] = points_[facet.corner[k]];
      }
      if (result.depth - facet.distance <= tolerance * size_ || is_corner(facet, p)) break;
      points_.push_back(p);
      if (!add_point(nearest, static_cast<int>(points_.size()) - 1)) break;
    }
    return result;
  }

 private:
  const Vec3& w(int i) const { return points_[i].w; }

  bool is_corner(const PolytopeFacet& facet, const MinkowskiPoint& p) const {
    return std::any_of(facet.corner.begin(), facet.corner.end(),
                       [&](int c) { return points_[c].a == p.a && points_[c].b == p.b; });
  }

  /// Four points that span a volume, from what GJK left.
  bool make_tetrahedron() {
    const double least = 1e-12 * size_;
    const auto try_direction = [&](const Vec3& d, auto&& is_new) {
      for (const double sign : {1.0, -1.0}) {
        const MinkowskiPoint p = difference_.support(sign * d);
        size_ = std::max(size_, p.w.norm());
        if (!is_new(p.w)) continue;
        points_.push_back(p);
        return true;
      }
      return false;
    };
    flat_direction_ = Vec3::UnitY();
    if (points_.size() == 4 && std::abs(volume(0, 1, 2, 3)) <= least * least * least) points_.pop_back();
    if (points_.size() == 1) {
      const auto is_new = [&](const Vec3& x) { return (x - w(0)).norm() > least; };
      if (!try_direction(Vec3::UnitX(), is_new) && !try_direction(Vec3::UnitY(), is_new) &&
          !try_direction(Vec3::UnitZ(), is_new))
        return false;
    }
    if (points_.size() == 2) {
      const Vec3 along = (w(1) - w(0)).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
      const auto is_new = [&](const Vec3& x) { return along.cross(x - w(0)).norm() > least; };
      flat_direction_ = u;
      if (!try_direction(u, is_new) && !try_direction(v, is_new)) return false;
    }
    if (points_.size() == 3) {
      const Vec3 n = accurate_cross(w(1) - w(0), w(2) - w(0)).normalized();
      flat_direction_ = n;
      if (!try_direction(n, [&](const Vec3& x) { return std::abs(n.dot(x - w(0))) > least; })) return false;
    }
    if (orientation(w(0), w(1), w(2), w(3)) < 0) std::swap(points_[1], points_[2]);
    const std::array<int, 3> base{0, 1, 2};
    add_facet(base, {1, 2, 3});
    for (int k = 0; k < 3; ++k) add_facet({base[(k + 1) % 3], base[k], 3}, {0, 1 + (k + 2) % 3, 1 + (k + 1) % 3});
    return true;
  }

  double volume(int a, int b, int c, int d) const { return (w(b) - w(a)).cross(w(c) - w(a)).dot(w(d) - w(a)); }

  PolytopeFacet make_facet(const std::array<int, 3>& corner, const std::array<int, 3>& neighbour) const {
    PolytopeFacet f{corner, neighbour};
    f.normal = accurate_cross(w(corner[1]) - w(corner[0]), w(corner[2]) - w(corner[0]));
    const double length = f.normal.norm();
    if (length > 0.0) f.normal /= length;
    // the corner nearest to the origin tells its distance with the least rounding
    f.distance = f.normal.dot(w(*std::min_element(
        corner.begin(), corner.end(), [&](int l, int r) { return w(l).squaredNorm() < w(r).squaredNorm(); })));
    // without area it has no plane: never the nearest, and swallowed with its neighbours
    if (!(length > 0.0)) f.distance = 1e300;
    return f;
  }

  /// Of equal distances the facet made first.
  int nearest_facet() {
    while (facets_[queue_.front().second].is_gone) {
      std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
      queue_.pop_back();
    }
    return queue_.front().second;
  }

  void add_facet(const std::array<int, 3>& corner, const std::array<int, 3>& neighbour) {
    facets_.push_back(make_facet(corner, neighbour));
    queue_.emplace_back(facets_.back().distance, static_cast<int>(facets_.size()) - 1);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  }

  /// For certain: a point that is in the plane as far as doubles can tell is not seen, so that flat sides of the
  /// difference stay flat.
  bool sees(int p, const PolytopeFacet& f) const {
    const Vec3 &a = w(f.corner[0]), u = w(f.corner[1]) - a, v = w(f.corner[2]) - a, x = w(p) - a;
    const double height = u.cross(v).dot(x);
    return height > 1e-15 * size_ * u.norm() * v.norm();
  }

  /// Replaces the facets that the point sees, one of which is `first`, by a cone from their rim. False if rounding has
  /// put the point on none's outer side.
  bool add_point(int first, int p) {
    if (!sees(p, facets_[first])) return false;
    seen_.assign(1, first);
    facets_[first].is_gone = true;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      for (const int next : facets_[seen_[i]].neighbour)
        if (!facets_[next].is_gone && sees(p, facets_[next])) {
          facets_[next].is_gone = true;
          seen_.push_back(next);
        }
    rim_.clear();
    for (int s : seen_)
      for (int k = 0; k < 3; ++k) {
        const int next = facets_[s].neighbour[k];
        if (!facets_[next].is_gone) rim_.push_back({facets_[s].corner[k], facets_[s].corner[(k + 1) % 3], next, -1});
      }
    const int base = static_cast<int>(facets_.size()), count = static_cast<int>(rim_.size());
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        if (rim_[j].from == rim_[i].to) rim_[i].next = j;
    for (int i = 0; i < count; ++i) {
      if (rim_[i].next < 0) return false;
      add_facet({rim_[i].from, rim_[i].to, p}, {rim_[i].beyond, base + rim_[i].next, -1});
    }
    for (int i = 0; i < count; ++i) {
      facets_[base + rim_[i].next].neighbour[2] = base + i;
      PolytopeFacet& beyond = facets_[rim_[i].beyond];
      for (int k = 0; k < 3; ++k)
        if (beyond.corner[k] == rim_[i].to && beyond.corner[(k + 1) % 3] == rim_[i].from)
          beyond.neighbour[k] = base + i;
    }
    return true;
  }

  struct RimSide {
    int from, to, beyond, next;
  };

  const MinkowskiDifference& difference_;
  double size_;
  std::vector<MinkowskiPoint> points_;
  std::vector<PolytopeFacet> facets_;
  std::vector<std::pair<double, int>> queue_;  ///< a heap of distances and facets, those that are gone too
  std::vector<RimSide> rim_;
  std::vector<int> seen_;
  Vec3 flat_direction_ = Vec3::UnitY();
};

}  // namespace

PolytopeResult expand_polytope(const MinkowskiDifference& difference, const GjkResult& start, double tolerance,
                               int most_steps) {
  return Polytope(difference, start).run(tolerance, most_steps);
}

}  // namespace impinge
