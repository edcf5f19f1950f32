#include "engine/geometry/mend/decimate.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <queue>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/collapsing_surface.hpp"
#include "engine/geometry/mend/crossing_guard.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"
#include "engine/geometry/mend/quadric.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {
namespace {

constexpr double kBorder = 10.0;  // weight of planes that stand on borders, beside the triangles' areas
constexpr double kFree = 1e-5;    // of a quadric's largest curvature: along what has less, places are as good as any
constexpr double kShortFirst = 1e-6;  // of area times length²: among edges that cost nothing short ones go first

/// How far a collapse may go. What doesn't go gently is tried again as if it cost more.
struct Manners {
  double price;  ///< times the cost
  double turn;   ///< least cosine between a triangle's normals before and after
  double shape;  ///< least height over the longest side, unless one was worse before
  bool any_end;  ///< whether the new vertex may also be an end or the middle, which does not keep the volume
};
constexpr Manners kManners[] = {{1.0, 0.2, 0.1, false}, {10.0, 0.0, 0.02, false}, {1000.0, 0.0, 1e-4, true}};

/// Of a quadric's matrix, on the directions that it says something about.
Mat3 partial_inverse(const Mat3& a) {
  const Eigen::SelfAdjointEigenSolver<Mat3> own(a);
  Vec3 inverse = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (own.eigenvalues()[i] > kFree * own.eigenvalues()[2]) inverse[i] = 1.0 / own.eigenvalues()[i];
  return own.eigenvectors() * inverse.asDiagonal() * own.eigenvectors().transpose();
}

double shape_of(const TriangleCorners& c) {
  const double longest_sq =
      std::max({(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
  return longest_sq > 0.0 ? normal_of(c).norm() / longest_sq : 0.0;
}

struct Candidate {
  double cost;
  int a, b;        // a < b
  unsigned stamp;  // of both when it was made
  std::size_t manners = 0;
  bool operator<(const Candidate& o) const { return std::tie(cost, a, b) > std::tie(o.cost, o.a, o.b); }
};

class Decimator {
 public:
  using Ring = CollapsingSurface::Ring;

  explicit Decimator(const TriangleMesh& mesh)
      : surface_(mesh),
        quadric_(mesh.vertices.size()),
        tangled_(mesh.vertices.size(), 0),
        stamp_(mesh.vertices.size(), 0) {
    Aabb box;
    for (const Triangle& t : mesh.triangles)
      for (const int v : t) box.include(mesh.vertices[v]);
    middle_ = box.center();
    add_quadrics(make_topology(mesh));
    bool more = false;
    for (const auto& [s, t] : find_crossings(mesh, more))
      for (const int i : {s, t})
        for (const int v : mesh.triangles[i]) tangled_[v] = 1;
    guard_.emplace(surface_.triangles(), surface_.vertices(), tangled_);
  }

  TriangleMesh run(int most) {
    for (bool goes_on = true; goes_on && surface_.triangle_count() > most;) goes_on = pass(most);
    return surface_.mesh();
  }

 private:
  void add_quadrics(const MeshTopology& topology) {
    for (int t = 0; t < surface_.triangle_count(); ++t) {
      const TriangleCorners c = surface_.corners(t);
      const double twice_area = normal_of(c).norm();
      if (!(twice_area > 0.0)) continue;
      const Vec3 normal = normal_of(c) / twice_area;
      for (const int v : surface_.triangles()[t])
        quadric_[v].add_plane(normal, normal.dot(c[0] - middle_), 0.5 * twice_area);
    }
    for (const MeshTopology::Edge& edge : topology.edges) {
      if (edge.triangle1 >= 0) continue;
      const Vec3 &from = at(edge.v0), along = at(edge.v1) - from;
      const Vec3 upright = along.cross(normal_of(surface_.corners(edge.triangle0)));
      if (!(upright.norm() > 0.0)) continue;
      const Vec3 normal = upright.normalized();
      for (const int v : {edge.v0, edge.v1})
        quadric_[v].add_plane(normal, normal.dot(from - middle_), kBorder * along.squaredNorm());
    }
  }

  const Vec3& at(int v) const { return surface_.vertices()[v]; }

  struct Place {
    Vec3 x;
    double cost;
  };
  Place place(int a, int b, const Quadric& q, const Vec3& x) const {
    return {x, q.at(x - middle_) + kShortFirst * q.a.trace() * (at(b) - at(a)).squaredNorm()};
  }

  /// Where a vertex in place of both is best.
  Place best_place(int a, int b, const Ring& ring) const {
    Quadric q = quadric_[a];
    q += quadric_[b];
    // a border stays where it is
    if (surface_.is_on_border(a) != surface_.is_on_border(b))
      return place(a, b, q, surface_.is_on_border(a) ? at(a) : at(b));
    const Vec3 between = 0.5 * (at(a) + at(b));
    const Mat3 inverse = partial_inverse(q.a);
    Vec3 d = -inverse * (q.a * (between - middle_) + q.b);
    if (!surface_.is_on_border(a)) {
      // the new fan spans as much with the middle as the ring does: six times that volume, and its gradient
      double volume = 0.0;
      for (const int t : ring.all()) {
        const TriangleCorners c = surface_.corners(t);
        volume += (c[0] - between).dot((c[1] - between).cross(c[2] - between));
      }
      Vec3 gradient = Vec3::Zero();
      for (const int t : ring.kept) {
        const Triangle& own = surface_.triangles()[t];
        int k = 0;
        while (own[k] != a && own[k] != b) ++k;
        gradient += (at(own[(k + 1) % 3]) - between).cross(at(own[(k + 2) % 3]) - between);
      }
      const double give = gradient.dot(inverse * gradient);
      if (give > 0.0) d += inverse * gradient * ((volume - gradient.dot(d)) / give);
    }
    return place(a, b, q, d.allFinite() ? Vec3(between + d) : between);
  }

  /// The ring with one vertex in place of two; empty where a triangle would turn over or become a sliver.
  std::vector<NewTriangle> fan_of(int a, int b, const Vec3& x, const Ring& ring, const Manners& manners) const {
    std::vector<NewTriangle> fan;
    double worst_before = 1.0, worst = 1.0;
    for (const int t : ring.all()) worst_before = std::min(worst_before, shape_of(surface_.corners(t)));
    for (const int t : ring.kept) {
      const TriangleCorners before = surface_.corners(t);
      NewTriangle own{surface_.triangles()[t], before};
      for (int k = 0; k < 3; ++k)
        if (own.vertices[k] == a || own.vertices[k] == b) own.vertices[k] = a, own.corners[k] = x;
      const Vec3 old_normal = normal_of(before), normal = normal_of(own.corners);
      if (!(normal.norm() > 0.0) || normal.dot(old_normal) < manners.turn * normal.norm() * old_normal.norm())
        return {};
      worst = std::min(worst, shape_of(own.corners));
      fan.push_back(own);
    }
    if (worst < std::min(manners.shape, worst_before)) fan.clear();
    return fan;
  }

  void push(int a, int b) {
    if (a > b) std::swap(a, b);
    if (surface_.may_join(a, b)) heap_.push({best_place(a, b, surface_.ring(a, b)).cost, a, b, stamp_[a] + stamp_[b]});
  }

  bool try_join(int a, int b, const Vec3& x, const Ring& ring, const Manners& manners) {
    const std::vector<NewTriangle> fan = fan_of(a, b, x, ring, manners);
    if (fan.empty() || guard_->is_crossing(fan, ring.all())) return false;
    surface_.join(a, b, x, ring);
    for (const int t : ring.kept) guard_->move(t);
    for (const int t : ring.lost) guard_->drop(t);
    quadric_[a] += quadric_[b];
    tangled_[a] |= tangled_[b];
    ++stamp_[a];
    ++stamp_[b];
    for (const int w : surface_.neighbours(a)) push(a, w);
    return true;
  }

  bool join_if_allowed(int a, int b, const Place& best, const Ring& ring, const Manners& manners) {
    if (try_join(a, b, best.x, ring, manners)) return true;
    if (!manners.any_end || surface_.is_on_border(a) != surface_.is_on_border(b)) return false;
    for (const Vec3& x : {Vec3(0.5 * (at(a) + at(b))), Vec3(at(a)), Vec3(at(b))})
      if (try_join(a, b, x, ring, manners)) return true;
    return false;
  }

  /// All edges once, cheapest first. Whether anything was joined.
  bool pass(int most) {
    heap_ = {};
    for (int v = 0; v < surface_.vertex_count(); ++v) {
      poll_();
      for (const int w : surface_.neighbours(v))
        if (v < w) push(v, w);
    }
    const int before = surface_.triangle_count();
    while (!heap_.empty() && surface_.triangle_count() > most) {
      poll_();
      const Candidate least = heap_.top();
      heap_.pop();
      if (stamp_[least.a] + stamp_[least.b] != least.stamp || !surface_.may_join(least.a, least.b)) continue;
      const Ring ring = surface_.ring(least.a, least.b);
      const Place best = best_place(least.a, least.b, ring);
      const auto again = [&](std::size_t manners) {
        heap_.push({best.cost * kManners[manners].price, least.a, least.b, least.stamp, manners});
      };
      // what is round it may have moved since
      const double cost = best.cost * kManners[least.manners].price;
      if (cost > least.cost && !heap_.empty() && cost > heap_.top().cost)
        again(least.manners);
      else if (!join_if_allowed(least.a, least.b, best, ring, kManners[least.manners]) &&
               least.manners + 1 < std::size(kManners))
        again(least.manners + 1);
    }
    return surface_.triangle_count() < before;
  }

  CollapsingSurface surface_;
  std::vector<Quadric> quadric_;
  std::vector<char> tangled_;  // crosses something as it was given
  std::vector<unsigned> stamp_;
  Vec3 middle_ = Vec3::Zero();  // that quadrics are about
  std::optional<CrossingGuard> guard_;
  std::priority_queue<Candidate> heap_;
  InterruptPoll poll_;
};

/// Of a vertex of `from` that a triangle has from the surface of `to`.
double farthest(const TriangleMesh& from, const TriangleMesh& to) {
  const BoxTree tree(triangle_boxes(to.triangles, to.vertices));
  std::vector<char> used(from.vertices.size(), 0);
  for (const Triangle& t : from.triangles)
    for (const int v : t) used[v] = 1;
  std::vector<double> distance_sq(from.vertices.size(), 0.0);
  parallel_for(distance_sq.size(), 64, [&](std::size_t v) {
    if (used[v] != 0)
      distance_sq[v] = nearest_triangle(tree, to.triangles, to.vertices, from.vertices[v]).at.squared_distance;
  });
  return std::sqrt(*std::max_element(distance_sq.begin(), distance_sq.end()));
}

}  // namespace

double decimate_memory(const TriangleMesh& mesh) {
  // quadrics and rings by vertex; a tree, and an edge's entries in the heap until they are come to, by triangle
  return 190.0 * static_cast<double>(mesh.vertices.size()) + 400.0 * static_cast<double>(mesh.triangles.size());
}

DecimatedMesh decimate(const TriangleMesh& mesh, int most) {
  DecimatedMesh result{mesh, {}};
  DecimateReport& report = result.report;
  report.triangles_before = report.triangles_after = static_cast<int>(mesh.triangles.size());
  report.volume_before = report.volume_after = signed_volume(mesh);
  if (report.triangles_before <= most) return result;
  result.mesh = Decimator(mesh).run(most);
  report.triangles_after = static_cast<int>(result.mesh.triangles.size());
  report.volume_after = signed_volume(result.mesh);
  report.farthest = std::max(farthest(mesh, result.mesh), farthest(result.mesh, mesh));
  return result;
}

}  // namespace impinge
