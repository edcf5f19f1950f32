#include "engine/geometry/convex/convex_hull.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/geometry/convex/orientation.hpp"

namespace impinge {
namespace {

constexpr double kFlat = 1e-10;  // of the extent: thinner than this a solid has no faces but rounding

struct Facet {
  Triangle corner;
  std::array<int, 3> neighbour;  ///< across the edge from corner k to corner k + 1
  std::vector<int> outside;      ///< points that see it and no facet before it
  bool is_gone = false;
};

class Quickhull {
 public:
  explicit Quickhull(std::span<const Vec3> points) : points_(points) {}

  std::string run() {
    std::string problem = make_simplex();
    if (!problem.empty()) return problem;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      while (!facets_[f].is_gone && !facets_[f].outside.empty()) add_point(static_cast<int>(f));
    return {};
  }

  ConvexHull result() const {
    ConvexHull hull;
    for (const Facet& f : facets_)
      if (!f.is_gone) hull.source.insert(hull.source.end(), f.corner.begin(), f.corner.end());
    std::sort(hull.source.begin(), hull.source.end());
    hull.source.erase(std::unique(hull.source.begin(), hull.source.end()), hull.source.end());
    for (int p : hull.source) hull.mesh.vertices.push_back(points_[p]);
    const auto index = [&](int p) {
      return static_cast<int>(std::lower_bound(hull.source.begin(), hull.source.end(), p) - hull.source.begin());
    };
    for (const Facet& f : facets_)
      if (!f.is_gone) hull.mesh.triangles.push_back({index(f.corner[0]), index(f.corner[1]), index(f.corner[2])});
    return hull;
  }

 private:
  bool sees(int p, const Facet& f) const {
    return orientation(points_[f.corner[0]], points_[f.corner[1]], points_[f.corner[2]], points_[p]) < 0;
  }

  double height(int p, const Facet& f) const {
    const Vec3& a = points_[f.corner[0]];
    return (points_[f.corner[1]] - a).cross(points_[f.corner[2]] - a).dot(points_[p] - a);
  }

  /// Four points far apart from each other as the first facets.
  std::string make_simplex() {
    const int count = static_cast<int>(points_.size());
    const auto farthest = [&](auto&& measure) {
      int best = 0;
      double most = -1.0;
      for (int i = 0; i < count; ++i)
        if (const double m = measure(points_[i]); m > most) most = m, best = i;
      return best;
    };
    if (count == 0) return "has no points";
    Vec3 low = points_[0], high = points_[0];
    for (const Vec3& x : points_) low = low.cwiseMin(x), high = high.cwiseMax(x);
    const double extent = (high - low).norm();
    const Vec3 middle = low + 0.5 * (high - low);
    const int a = farthest([&](const Vec3& x) { return (x - middle).squaredNorm(); });
    const int b = farthest([&](const Vec3& x) { return (x - points_[a]).squaredNorm(); });
    if (!(extent > 0.0)) return "has one point only";
    const Vec3 ab = points_[b] - points_[a];
    const int c = farthest([&](const Vec3& x) { return ab.cross(x - points_[a]).squaredNorm(); });
    if (!(ab.cross(points_[c] - points_[a]).norm() > kFlat * extent * ab.norm())) return "has all points on a line";
    const Vec3 normal = ab.cross(points_[c] - points_[a]).normalized();
    const int d = farthest([&](const Vec3& x) { return std::abs(normal.dot(x - points_[a])); });
    const double thickness = std::abs(normal.dot(points_[d] - points_[a]));
    const int side = orientation(points_[a], points_[b], points_[c], points_[d]);
    if (!(thickness > kFlat * extent) || side == 0)
      return fmt::format("has all points in a plane (it is {:.3g} m thick and {:.3g} m long)", thickness, extent);

    const Triangle base = side > 0 ? Triangle{a, b, c} : Triangle{a, c, b};
    // each facet, counter-clockwise seen from outside, across from the corner it does not have
    facets_.push_back({base, {1, 2, 3}, {}, false});
    for (int k = 0; k < 3; ++k)
      facets_.push_back({{base[(k + 1) % 3], base[k], d}, {0, 1 + (k + 2) % 3, 1 + (k + 1) % 3}, {}, false});
    std::vector<int> all;
    for (int i = 0; i < count; ++i)
      if (i != a && i != b && i != c && i != d) all.push_back(i);
    share_out(all, 0);
    return {};
  }

  /// Gives each point to the first facet from number `first` on that it sees; one that sees none is inside.
  void share_out(const std::vector<int>& points, std::size_t first) {
    for (int p : points)
      for (std::size_t f = first; f < facets_.size(); ++f)
        if (!facets_[f].is_gone && sees(p, facets_[f])) {
          facets_[f].outside.push_back(p);
          break;
        }
  }

  /// Replaces all facets that the farthest point of facet f sees by a cone from their rim to the point.
  void add_point(int f) {
    const std::vector<int>& own = facets_[f].outside;
    const int top = *std::max_element(own.begin(), own.end(),
                                      [&](int l, int r) { return height(l, facets_[f]) < height(r, facets_[f]); });
    std::vector<int> seen{f};
    facets_[f].is_gone = true;
    struct RimEdge {
      int from, to, beyond;
    };
    std::vector<RimEdge> rim;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::array<int, 3> neighbours = facets_[seen[i]].neighbour;
      for (int next : neighbours)
        if (!facets_[next].is_gone && sees(top, facets_[next])) {
          facets_[next].is_gone = true;
          seen.push_back(next);
        }
    }
    std::sort(seen.begin(), seen.end());
    const auto is_seen = [&](int n) { return std::binary_search(seen.begin(), seen.end(), n); };
    std::vector<int> orphans;
    for (int s : seen) {
      for (int k = 0; k < 3; ++k)
        if (const int next = facets_[s].neighbour[k]; !is_seen(next))
          rim.push_back({facets_[s].corner[k], facets_[s].corner[(k + 1) % 3], next});
      for (int p : facets_[s].outside)
        if (p != top) orphans.push_back(p);
      facets_[s].outside = {};
    }
    std::sort(orphans.begin(), orphans.end());

    // the rim is one closed loop: what is seen of a convex surface is connected and so is the rest
    const std::size_t first = facets_.size();
    std::map<int, int> facet_from;
    for (std::size_t i = 0; i < rim.size(); ++i) facet_from[rim[i].from] = static_cast<int>(first + i);
    for (const RimEdge& e : rim)
      facets_.push_back({{e.from, e.to, top}, {e.beyond, facet_from.at(e.to), -1}, {}, false});
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const int own_number = static_cast<int>(first + i);
      facets_[facets_[own_number].neighbour[1]].neighbour[2] = own_number;
      Facet& beyond = facets_[rim[i].beyond];
      for (int k = 0; k < 3; ++k)
        if (beyond.corner[k] == rim[i].to && beyond.corner[(k + 1) % 3] == rim[i].from)
          beyond.neighbour[k] = own_number;
    }
    share_out(orphans, first);
  }

  std::span<const Vec3> points_;
  std::vector<Facet> facets_;
};

}  // namespace

ConvexHull convex_hull(std::span<const Vec3> points) {
  // of equal points (0 equals -0) the first stands for all: a repeated corner would be a corner of two cones
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto key = [&](int i) { return std::tuple(points[i].x(), points[i].y(), points[i].z()); };
  std::sort(order.begin(), order.end(), [&](int l, int r) { return key(l) != key(r) ? key(l) < key(r) : l < r; });
  order.erase(std::unique(order.begin(), order.end(), [&](int l, int r) { return key(l) == key(r); }), order.end());
  std::sort(order.begin(), order.end());
  std::vector<Vec3> different;
  different.reserve(order.size());
  for (int i : order) different.push_back(points[i]);

  ConvexHull hull;
  if (different.size() < 4) {
    hull.problem = fmt::format("has {} different point{}", different.size(), different.size() == 1 ? "" : "s");
    return hull;
  }
  Quickhull quickhull(different);
  std::string problem = quickhull.run();
  if (problem.empty())
    hull = quickhull.result();
  else
    hull.problem = std::move(problem);
  for (int& s : hull.source) s = order[s];
  return hull;
}

}  // namespace impinge
