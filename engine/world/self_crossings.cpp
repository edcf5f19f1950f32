#include "engine/world/self_crossings.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/box_tree.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

/// Each pair of leaves that may meet is looked at from the one whose triangle comes first.
class SelfSearch {
 public:
  SelfSearch(const SurfaceMesh& surface, std::span<const Vec3> vertices)
      : triangles_(surface.mesh.triangles), vertices_(vertices), tree_(surface.tree()) {
    for (const Aabb& box : triangle_boxes(triangles_, vertices)) boxes_.push_back(box.inflated(touch_of(box)));
    tree_.fit(boxes_, fitted_);
  }

  std::int64_t count() const {
    std::vector<std::int64_t> found(triangles_.size(), 0);
    parallel_for(triangles_.size(), 64, [&](std::size_t i) { found[i] = with_later(static_cast<int>(i)); });
    return std::accumulate(found.begin(), found.end(), std::int64_t{0});
  }

 private:
  /// What triangles_intersect takes for touching, so that no box misses it.
  static double touch_of(const Aabb& box) { return 2.0 * kTouchTolerance * largest_coordinate(box); }

  TriangleCorners corners(int t) const {
    const Triangle& at = triangles_[static_cast<std::size_t>(t)];
    return {vertices_[at[0]], vertices_[at[1]], vertices_[at[2]]};
  }

  bool share_a_vertex(int s, int t) const {
    const Triangle &a = triangles_[static_cast<std::size_t>(s)], &b = triangles_[static_cast<std::size_t>(t)];
    return std::any_of(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
  }

  std::int64_t with_later(int triangle) const {
    if (tree_.is_empty()) return 0;
    const Aabb& box = boxes_[static_cast<std::size_t>(triangle)];
    const TriangleCorners own = corners(triangle);
    std::int64_t count = 0;
    std::vector<int> open = {0};
    while (!open.empty()) {
      const int n = open.back();
      open.pop_back();
      if (!overlap(fitted_[static_cast<std::size_t>(n)], box)) continue;
      const BoxTree::Node& node = tree_.nodes()[static_cast<std::size_t>(n)];
      if (!node.is_leaf()) {
        open.push_back(n + 1), open.push_back(node.second);
        continue;
      }
      for (int k = node.first; k < node.first + node.count; ++k) {
        const int other = tree_.order()[static_cast<std::size_t>(k)];
        if (other > triangle && overlap(boxes_[static_cast<std::size_t>(other)], box) &&
            !share_a_vertex(triangle, other) && triangles_intersect(own, corners(other)))
          ++count;
      }
    }
    return count;
  }

  std::span<const Triangle> triangles_;
  std::span<const Vec3> vertices_;
  const BoxTree& tree_;
  std::vector<Aabb> boxes_, fitted_;
};

}  // namespace

std::int64_t count_self_crossings(const Bodies& bodies) {
  std::int64_t count = 0;
  for (const Body& body : bodies) {
    if (body.kind() != BodyKind::deformable || body.shape->mesh() == nullptr) continue;
    check_interrupt();
    count += SelfSearch(*body.shape->mesh(), body.world_vertices).count();
  }
  return count;
}

}  // namespace impinge
