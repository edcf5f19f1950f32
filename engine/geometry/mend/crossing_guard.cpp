#include "engine/geometry/mend/crossing_guard.hpp"

#include <algorithm>

#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

constexpr double kClear = 1e-9;      // sine of an angle, far above rounding
constexpr double kFolded = -0.9999;  // cosine between the normals of neighbours that lie on each other: 0.8°

bool has(const Triangle& t, int vertex) { return t[0] == vertex || t[1] == vertex || t[2] == vertex; }

/// Of a triangle the sides that leave the corner it shares with another.
struct Wedge {
  Vec3 left, right, normal;
  Wedge(const NewTriangle& own, const Triangle& other) {
    int k = 0;
    while (!has(other, own.vertices[k])) ++k;
    left = own.corners[(k + 1) % 3] - own.corners[k];
    right = own.corners[(k + 2) % 3] - own.corners[k];
    normal = left.cross(right);
  }
  bool is_beyond(const Vec3& plane) const {
    const double band = kClear * plane.norm();
    return left.dot(plane) < -band * left.norm() && right.dot(plane) < -band * right.norm();
  }
};

/// Whether a plane through the shared corner clearly parts them; false settles nothing.
bool are_parted(const Wedge& a, const Wedge& b) {
  const auto by_a_plane_of = [](const Wedge& one, const Wedge& other) {
    return other.is_beyond(one.normal) || other.is_beyond(-one.normal) || other.is_beyond(one.normal.cross(one.left)) ||
           other.is_beyond(one.right.cross(one.normal));
  };
  return by_a_plane_of(a, b) || by_a_plane_of(b, a);
}

/// The side across the one corner that `other` has as well, as a triangle without area.
TriangleCorners side_across(const NewTriangle& own, const Triangle& other) {
  for (int k = 0; k < 3; ++k)
    if (has(other, own.vertices[k]))
      return {own.corners[(k + 1) % 3], own.corners[(k + 2) % 3], own.corners[(k + 2) % 3]};
  return own.corners;
}

/// Whether they have more in common than their vertices' numbers say.
bool meet(const NewTriangle& a, const NewTriangle& b) {
  const auto shared = std::count_if(a.vertices.begin(), a.vertices.end(), [&](int v) { return has(b.vertices, v); });
  if (shared == 0) return triangles_intersect(a.corners, b.corners);
  if (shared == 1)
    return !are_parted({a, b.vertices}, {b, a.vertices}) &&
           (triangles_intersect(side_across(a, b.vertices), b.corners) ||
            triangles_intersect(side_across(b, a.vertices), a.corners));
  if (shared == 3) return true;
  const Vec3 na = normal_of(a.corners), nb = normal_of(b.corners);
  return na.dot(nb) < kFolded * na.norm() * nb.norm();
}

}  // namespace

CrossingGuard::CrossingGuard(const std::vector<Triangle>& triangles, const std::vector<Vec3>& vertices,
                             const std::vector<char>& tangled)
    : triangles_(triangles),
      vertices_(vertices),
      tangled_(tangled),
      gone_(triangles.size(), 0),
      left_out_(triangles.size(), 0) {
  build();
}

TriangleCorners CrossingGuard::corners_of(int triangle) const {
  const Triangle& t = triangles_[triangle];
  return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
}

void CrossingGuard::build() {
  triangle_of_.clear();
  own_.clear();
  slot_of_.assign(triangles_.size(), -1);
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    if (gone_[t] != 0) continue;
    slot_of_[t] = static_cast<int>(triangle_of_.size());
    triangle_of_.push_back(t);
    const TriangleCorners c = corners_of(t);
    own_.push_back(bounds_of(c[0], c[1], c[2]));
  }
  in_tree_ = static_cast<int>(triangle_of_.size());
  dropped_ = 0;
  tree_ = BoxTree(own_);
  tree_.fit(own_, fitted_);
  parent_.assign(tree_.nodes().size(), -1);
  leaf_of_.assign(own_.size(), -1);
  for (int n = 0; n < static_cast<int>(parent_.size()); ++n) {
    const BoxTree::Node& node = tree_.nodes()[n];
    for (int i = node.first; i < node.first + node.count; ++i) leaf_of_[tree_.order()[i]] = n;
    if (!node.is_leaf()) parent_[n + 1] = parent_[node.second] = n;
  }
}

void CrossingGuard::fit_from(int triangle) {
  const int slot = slot_of_[triangle];
  own_[slot] = Aabb();
  if (gone_[triangle] == 0) {
    const TriangleCorners c = corners_of(triangle);
    own_[slot] = bounds_of(c[0], c[1], c[2]);
  }
  for (int n = leaf_of_[slot]; n >= 0; n = parent_[n]) {
    const BoxTree::Node& node = tree_.nodes()[n];
    Aabb box;
    if (node.is_leaf()) {
      for (int i = node.first; i < node.first + node.count; ++i) box.include(own_[tree_.order()[i]]);
    } else {
      box = fitted_[n + 1];
      box.include(fitted_[node.second]);
    }
    if (box.min == fitted_[n].min && box.max == fitted_[n].max) return;
    fitted_[n] = box;
  }
}

void CrossingGuard::move(int triangle) { fit_from(triangle); }

void CrossingGuard::drop(int triangle) {
  gone_[triangle] = 1;
  // boxes that were made for twice as many overlap more than need be
  if (++dropped_ * 2 > in_tree_)
    build();
  else
    fit_from(triangle);
}

bool CrossingGuard::meets_surface(const NewTriangle& own) {
  const Aabb box = bounds_of(own.corners[0], own.corners[1], own.corners[2]);
  bool found = false;
  tree_.search([&](int n) { return !found && overlap(fitted_[n], box); },
               [&](int slot) {
                 const int t = triangle_of_[slot];
                 if (found || left_out_[t] == question_ || !overlap(own_[slot], box) || is_tangled(triangles_[t]))
                   return;
                 found = meet(own, {triangles_[t], corners_of(t)});
               });
  return found;
}

bool CrossingGuard::is_crossing(std::span<const NewTriangle> fan, std::span<const int> replaces) {
  ++question_;
  for (const int t : replaces) left_out_[t] = question_;
  for (std::size_t i = 0; i < fan.size(); ++i) {
    if (is_tangled(fan[i].vertices)) continue;
    for (std::size_t k = 0; k < i; ++k)
      if (!is_tangled(fan[k].vertices) && meet(fan[i], fan[k])) return true;
    if (meets_surface(fan[i])) return true;
  }
  return false;
}

}  // namespace impinge
