#include "engine/world/self_crossings.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/surface/exempt_pairs.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr std::size_t kTasks = 64;

/// Two nodes whose triangles are held against each other; twice the same one: against themselves.
struct NodePair {
  int a, b;
};

/// A tree of boxes, walked against itself.
class SelfSearch {
 public:
  SelfSearch(const SurfaceMesh& surface, std::span<const Vec3> vertices, const ExemptPairs* exempt)
      : triangles_(surface.mesh.triangles), vertices_(vertices), tree_(surface.tree()), exempt_(exempt) {
    boxes_ = triangle_boxes(triangles_, vertices);
    double largest = 0.0;
    for (const Aabb& box : boxes_) largest = std::max(largest, largest_coordinate(box));
    touch_ = 2.0 * kTouchTolerance * largest;
    for (Aabb& box : boxes_) box = box.inflated(touch_);
    tree_.fit(boxes_, fitted_);
  }

  std::int64_t count() const {
    if (tree_.is_empty()) return 0;
    std::vector<NodePair> tasks = {{0, 0}};
    for (std::size_t i = 0; i < tasks.size() && tasks.size() - i < kTasks;) {
      std::vector<NodePair> parts;
      if (split(tasks[i], parts))
        tasks[i] = tasks.back(), tasks.pop_back(), tasks.insert(tasks.end(), parts.begin(), parts.end());
      else
        ++i;
    }
    std::vector<std::int64_t> found(tasks.size(), 0);
    parallel_for(tasks.size(), 1, [&](std::size_t i) { found[i] = walk(tasks[i]); });
    return std::accumulate(found.begin(), found.end(), std::int64_t{0});
  }

 private:
  const BoxTree::Node& node(int n) const { return tree_.nodes()[static_cast<std::size_t>(n)]; }
  const Aabb& box(int n) const { return fitted_[static_cast<std::size_t>(n)]; }

  /// The pairs that a pair comes to one level down; false: both are leaves.
  bool split(NodePair pair, std::vector<NodePair>& parts) const {
    const auto [a, b] = pair;
    if (a != b && !overlap(box(a), box(b))) return true;
    if (node(a).is_leaf() && node(b).is_leaf()) return false;
    if (a == b) {
      parts.insert(parts.end(), {{a + 1, a + 1}, {node(a).second, node(a).second}, {a + 1, node(a).second}});
      return true;
    }
    const auto size = [&](int n) { return box(n).extent().squaredNorm(); };
    const bool splits_a = node(b).is_leaf() || (!node(a).is_leaf() && size(a) > size(b));
    if (splits_a)
      parts.insert(parts.end(), {{a + 1, b}, {node(a).second, b}});
    else
      parts.insert(parts.end(), {{a, b + 1}, {a, node(b).second}});
    return true;
  }

  std::int64_t walk(NodePair from) const {
    std::int64_t count = 0;
    std::vector<NodePair> open = {from};
    InterruptPoll poll;
    while (!open.empty()) {
      poll();
      const NodePair pair = open.back();
      open.pop_back();
      if (!split(pair, open)) count += in_leaves(pair);
    }
    return count;
  }

  std::int64_t in_leaves(NodePair pair) const {
    const BoxTree::Node &a = node(pair.a), &b = node(pair.b);
    std::int64_t count = 0;
    for (int i = a.first; i < a.first + a.count; ++i)
      for (int j = pair.a == pair.b ? i + 1 : b.first; j < b.first + b.count; ++j)
        count += cross(tree_.order()[static_cast<std::size_t>(i)], tree_.order()[static_cast<std::size_t>(j)]) ? 1 : 0;
    return count;
  }

  bool cross(int s, int t) const {
    const Triangle &a = triangles_[static_cast<std::size_t>(s)], &b = triangles_[static_cast<std::size_t>(t)];
    if (!overlap(boxes_[static_cast<std::size_t>(s)], boxes_[static_cast<std::size_t>(t)])) return false;
    if (std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); }))
      return false;
    if (exempt_ != nullptr && exempt_->has(s, t)) return false;
    const TriangleCorners of_a = corners(a), of_b = corners(b);
    return !is_beside(of_a, of_b) && !is_beside(of_b, of_a) && triangles_intersect(of_a, of_b);
  }

  TriangleCorners corners(const Triangle& t) const { return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]}; }

  /// Whether the second lies on one side of the first one's plane, farther from it than what touches: most neighbours
  /// do.
  bool is_beside(const TriangleCorners& of, const TriangleCorners& other) const {
    const Vec3 normal = (of[1] - of[0]).cross(of[2] - of[0]);
    const double margin = 8.0 * touch_ * normal.norm();
    const double d0 = normal.dot(other[0] - of[0]), d1 = normal.dot(other[1] - of[0]),
                 d2 = normal.dot(other[2] - of[0]);
    return std::min({d0, d1, d2}) > margin || std::max({d0, d1, d2}) < -margin;
  }

  std::span<const Triangle> triangles_;
  std::span<const Vec3> vertices_;
  const BoxTree& tree_;
  const ExemptPairs* exempt_;
  std::vector<Aabb> boxes_, fitted_;
  double touch_ = 0.0;  // what triangles_intersect takes for touching, metres
};

}  // namespace

std::int64_t count_self_crossings(const Body& body, CrossingsOf which) {
  if (body.deleted || body.kind() != BodyKind::deformable || body.shape->mesh() == nullptr) return 0;
  if (which == CrossingsOf::self_colliding && !body.can_touch_itself()) return 0;
  check_interrupt();
  return SelfSearch(*body.shape->mesh(), body.world_vertices, body.exempt_pairs.get()).count();
}

std::int64_t count_self_crossings(const Bodies& bodies, CrossingsOf which) {
  std::int64_t count = 0;
  for (const Body& body : bodies) count += count_self_crossings(body, which);
  return count;
}

}  // namespace impinge
