#include "engine/world/judge_convex.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace impinge {
namespace {

constexpr std::size_t kFew = 100000;                    // edge pairs of polyhedra that are all looked at
constexpr int kSamples = 500;                           // directions, evenly over the sphere: some 0.17 rad apart
constexpr int kStarts = 6;                              // of them, those that are searched about
constexpr int kLineSteps = 26;                          // of a golden section
constexpr double kFirstWidth = 0.2, kLastWidth = 1e-9;  // radians either way

class ConvexOverlap {
 public:
  ConvexOverlap(const PlacedConvex& a, const PlacedConvex& b)
      : a_(a), b_(b), offset_(a.pose.position - b.pose.position) {}

  /// How far the solids overlap along a direction of any length.
  double along(const Vec3& n) const {
    const Vec3 to_a = a_.pose.rotation.transpose() * -n, to_b = b_.pose.rotation.transpose() * n;
    const double reach_a = to_a.dot(a_.set->support(to_a)), reach_b = to_b.dot(b_.set->support(to_b));
    return (reach_a + reach_b - n.dot(offset_)) / n.norm() + a_.set->rounding() + b_.set->rounding();
  }

  double of_polyhedra() const {
    const ConvexPolyhedron &a = *a_.set->polyhedron(), &b = *b_.set->polyhedron();
    double least = 1e300;
    const std::vector<Vec3> normals_a = directions(a_, a, true), normals_b = directions(b_, b, true);
    for (const Vec3& n : normals_a) least = std::min({least, along(n), along(-n)});
    for (const Vec3& n : normals_b) least = std::min({least, along(n), along(-n)});
    const std::vector<Vec3> edges_a = directions(a_, a, false), edges_b = directions(b_, b, false);
    for (const Vec3& u : edges_a)
      for (const Vec3& v : edges_b)
        // parallel edges: their axis is covered by the faces
        if (const Vec3 n = u.cross(v); n.norm() > 1e-9) least = std::min({least, along(n), along(-n)});
    return least;
  }

  double of_any() const {
    std::vector<std::pair<double, Vec3>> found;
    for (const PlacedConvex* p : {&a_, &b_})
      if (const ConvexPolyhedron* solid = p->set->polyhedron())
        for (const ConvexPolyhedron::Face& f : solid->faces())
          add(found, (p == &a_ ? -1.0 : 1.0) * (p->pose.rotation * f.normal));
    for (int i = 0; i < kSamples; ++i) {
      const double y = 1.0 - (2.0 * i + 1.0) / kSamples, r = std::sqrt(1.0 - y * y);
      const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
      add(found, {r * std::cos(angle), y, r * std::sin(angle)});
    }
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        add(found, sign * a_.pose.rotation.col(k));
        add(found, sign * b_.pose.rotation.col(k));
      }
    if (!offset_.isZero(0.0)) add(found, offset_.normalized());
    std::stable_sort(found.begin(), found.end(), [](const auto& l, const auto& r) { return l.first < r.first; });
    double least = found.front().first;
    std::vector<Vec3> starts;
    for (const auto& [depth, n] : found) {
      if (least <= 0.0 || starts.size() == kStarts) break;
      if (std::any_of(starts.begin(), starts.end(), [&, d = n](const Vec3& s) { return s.dot(d) > 0.95; })) continue;
      starts.push_back(n);
      least = std::min(least, search(n));
    }
    return least;
  }

 private:
  void add(std::vector<std::pair<double, Vec3>>& found, const Vec3& n) const { found.emplace_back(along(n), n); }

  /// Normals of faces or directions of edges in world axes, each once whatever its sign.
  static std::vector<Vec3> directions(const PlacedConvex& p, const ConvexPolyhedron& solid, bool of_faces) {
    std::vector<Vec3> list;
    const auto offer = [&](const Vec3& local) {
      const Vec3 n = (p.pose.rotation * local).normalized();
      const auto is_same = [&](const Vec3& k) { return k.cross(n).norm() < 1e-12; };
      if (list.size() > 64 || std::none_of(list.begin(), list.end(), is_same)) list.push_back(n);
    };
    if (of_faces)
      for (const ConvexPolyhedron::Face& f : solid.faces()) offer(f.normal);
    else
      for (const ConvexPolyhedron::Edge& e : solid.edges())
        offer(solid.vertices()[e.vertex1] - solid.vertices()[e.vertex0]);
    return list;
  }

  /// The least overlap about a direction: golden sections within golden sections over the plane that touches the
  /// sphere there. About a least overlap the surface of the two solids' difference is rounder than the ball that fits
  /// inside it, so the overlap falls towards it from all sides.
  double search(Vec3 n) const {
    double least = along(n);
    for (double width = kFirstWidth; width > kLastWidth; width *= 0.15) {
      const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
      double best_s = 0.0, best_t = 0.0;
      const auto inner = [&](double s) {
        double t = 0.0;
        const double depth = line_minimum([&](double x) { return along(n + s * u + x * v); }, width, t);
        if (depth < least) least = depth, best_s = s, best_t = t;
        return depth;
      };
      double s = 0.0;
      line_minimum(inner, width, s);
      n = (n + best_s * u + best_t * v).normalized();
    }
    return least;
  }

  template <class Function>
  static double line_minimum(Function f, double width, double& at) {
    constexpr double kGolden = 0.6180339887498949;
    double low = -width, high = width, a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    double fa = f(a), fb = f(b);
    for (int i = 0; i < kLineSteps; ++i) {
      if (fa <= fb) {
        high = b, b = a, fb = fa, a = high - kGolden * (high - low), fa = f(a);
      } else {
        low = a, a = b, fa = fb, b = low + kGolden * (high - low), fb = f(b);
      }
    }
    at = fa <= fb ? a : b;
    return std::min(fa, fb);
  }

  const PlacedConvex &a_, &b_;
  Vec3 offset_;
};

}  // namespace

double least_overlap(const PlacedConvex& a, const PlacedConvex& b) {
  const ConvexOverlap overlap(a, b);
  const ConvexPolyhedron *solid_a = a.set->polyhedron(), *solid_b = b.set->polyhedron();
  const bool few = solid_a != nullptr && solid_b != nullptr && solid_a->edges().size() * solid_b->edges().size() < kFew;
  return std::max(0.0, few ? overlap.of_polyhedra() : overlap.of_any());
}

}  // namespace impinge
