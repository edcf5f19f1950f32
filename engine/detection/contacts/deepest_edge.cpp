// An edge is cut into parts where it meets the other surface. The distance from one triangle is convex along a part, so
// that of its two ends bounds how deep the part can be: branch and bound on halves, the one that may be deepest first, each
// with the triangles that were nearest to what it was halved from. Where its middle is outside, all that is nearer to the
// middle than the surface is left out.
#include "engine/detection/contacts/deepest_edge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr double kNearlyDeepest = 1.05;  // what is no deeper than so many times the deepest known isn't looked for
constexpr double kSlack = 1e-9;          // an edge through one of the other's meets either triangle there
constexpr int kMostLooks = 400;          // of a part, in case of rounding

/// Where an edge meets the other surface.
struct Cut {
  double t;  ///< 0 at the edge's first vertex, 1 at its second
  bool enters;
  int triangle;
};

/// A part of an edge, and triangles of the other surface that are near.
struct Part {
  Vec3 p, q;
  int near_p, near_q;  ///< -1: none is known
  double most = 0.0;   ///< metres: no point of it is deeper
  friend bool operator<(const Part& l, const Part& r) { return l.most < r.most; }
};

class EdgeSearch {
 public:
  EdgeSearch(const EnclosingSurface& own, const EnclosingSurface& other, bool own_is_a, double known,
             std::optional<Collision>& deepest)
      : own_(own.view()), other_(other), own_is_a_(own_is_a), known_(known), deepest_(deepest) {}

  void add(int own_triangle, int other_triangle) {
    const TriangleCorners corners = other_.view().corners(other_triangle);
    const Vec3 normal = normal_of(corners);
    for (const int e : own_.triangle_edges(own_triangle)) {
      const Vec3 &p = own_.vertex(own_.edge(e).v0), along = own_.vertex(own_.edge(e).v1) - p;
      const std::optional<RayHit> hit = intersect_line(p, along, corners, kSlack);
      if (hit && hit->t > 0.0 && hit->t < 1.0) cuts_[e].push_back({hit->t, along.dot(normal) < 0.0, other_triangle});
    }
  }

  void run() {
    InterruptPoll poll;
    for (auto& [e, cuts] : cuts_) {
      poll();
      std::sort(cuts.begin(), cuts.end(), [](const Cut& l, const Cut& r) {
        return std::tuple(l.t, l.enters, l.triangle) < std::tuple(r.t, r.enters, r.triangle);
      });
      const Vec3 &p = own_.vertex(own_.edge(e).v0), along = own_.vertex(own_.edge(e).v1) - p;
      Cut from{0.0, false, -1};  // its other side says whether the first part is inside
      for (const Cut& to : cuts) {
        if (to.t > from.t && (from.enters || !to.enters))
          look_at(e, {p + from.t * along, p + to.t * along, from.triangle, to.triangle});
        from = to.t > from.t ? to : Cut{to.t, from.enters || to.enters, to.triangle};
      }
      if (from.enters) look_at(e, {p + from.t * along, p + along, from.triangle, -1});
    }
  }

 private:
  double best() const { return std::max(known_, deepest_ ? -deepest_->gap : 0.0); }

  double distance_to(int triangle, const Vec3& x) const {
    return std::sqrt(closest_on_triangle(x, other_.view().corners(triangle)).squared_distance);
  }

  Part bounded(Part part) const {
    part.most = std::numeric_limits<double>::infinity();
    for (const int t : {part.near_p, part.near_q})
      if (t >= 0) part.most = std::min(part.most, std::max(distance_to(t, part.p), distance_to(t, part.q)));
    return part;
  }

  void look_at(int e, const Part& whole) {
    std::priority_queue<Part> waiting;
    waiting.push(bounded(whole));
    for (int looks = 0; !waiting.empty() && looks < kMostLooks; ++looks) {
      const Part part = waiting.top();
      waiting.pop();
      if (part.most <= kNearlyDeepest * best()) return;
      const Vec3 half = 0.5 * (part.q - part.p), middle = part.p + half;
      const NearestTriangle out = other_.nearest(middle);
      const double distance = std::sqrt(out.at.squared_distance);
      bool is_inside = other_.is_behind(middle, out);
      if (is_inside && distance > best()) {
        is_inside = other_.winds_round(middle);
        if (is_inside) deepest_ = contact_inside(own_, {Feature::edge, e}, middle, out, own_is_a_);
      }
      // within that distance of a place that is outside nothing is inside
      const Vec3 skipped = is_inside ? Vec3::Zero() : Vec3(distance * half.normalized());
      if (skipped.squaredNorm() >= half.squaredNorm()) continue;
      waiting.push(bounded({part.p, middle - skipped, part.near_p, out.triangle}));
      waiting.push(bounded({middle + skipped, part.q, out.triangle, part.near_q}));
    }
  }

  const SurfaceView& own_;
  const EnclosingSurface& other_;
  bool own_is_a_;
  double known_;
  std::optional<Collision>& deepest_;
  std::map<int, std::vector<Cut>> cuts_;  // by edge
};

}  // namespace

void find_deepest_edge(const EnclosingSurface& own, const EnclosingSurface& other,
                       std::span<const TrianglePair* const> crossing, bool own_is_a, double known,
                       std::optional<Collision>& deepest) {
  EdgeSearch search(own, other, own_is_a, known, deepest);
  for (const TrianglePair* t : crossing)
    search.add(own_is_a ? t->triangle_a : t->triangle_b, own_is_a ? t->triangle_b : t->triangle_a);
  search.run();
}

}  // namespace impinge
