#include "engine/geometry/surface/searched_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/inside.hpp"

namespace impinge {
namespace {

constexpr double kRoom = 1e-9;    // of the surface's size
constexpr double kBeside = 1e-3;  // of a piece's size: so near to its box its triangles are looked at one by one
constexpr double kUndecided = 1e-6;
// A line may miss a triangle that it is parallel to, but for 1e-14, by a hundredth of the way to it and be said to meet it.
constexpr double kParallel = 0.02;

/// Whether the line from x meets the box, on that side or the other.
bool line_meets(const Aabb& box, const Vec3& x, const Vec3& direction) {
  double low = -INFINITY, high = INFINITY;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (x[k] < box.min[k] || x[k] > box.max[k]) return false;
      continue;
    }
    const double s = (box.min[k] - x[k]) / direction[k], t = (box.max[k] - x[k]) / direction[k];
    low = std::max(low, std::min(s, t)), high = std::min(high, std::max(s, t));
  }
  return low <= high;
}

/// Adds up angles that are mostly small by one arc tangent for many: as the argument of a product, which never gets near
/// where arguments jump.
class AngleSum {
 public:
  void add(double along, double across) {
    if (!(along > std::abs(across))) {
      sum_ += std::atan2(across, along);
      return;
    }
    const double t = across / along, x = x_ - y_ * t;
    y_ += x_ * t, x_ = x;
    if (!(x_ > std::abs(y_)) || x_ > 1e100) flush();
  }
  double take() {
    flush();
    return sum_;
  }

 private:
  void flush() {
    sum_ += std::atan2(y_, x_);
    x_ = 1.0, y_ = 0.0;
  }
  double sum_ = 0.0, x_ = 1.0, y_ = 0.0;
};

}  // namespace

SearchedMesh::SearchedMesh(const SurfaceMesh& surface, std::span<const Vec3> vertices, const NodeRims* rims)
    : surface_(&surface), vertices_(vertices), tree_(&surface.tree()), rims_(rims) {
  boxes_ = triangle_boxes(triangles(), vertices_);
  tree_->fit(boxes_, fitted_);
  const std::vector<int>& begin = surface.topology.vertex_triangle_begin;
  for (std::size_t v = 0; v + 1 < begin.size(); ++v)
    if (begin[v] == begin[v + 1]) loose_.push_back(static_cast<int>(v));
  if (fitted_.empty()) return;
  const double room = kRoom * (fitted_[0].extent().norm() + 1e-3 * largest_coordinate(fitted_[0]));
  for (Aabb& box : fitted_) box = box.inflated(room);
}

TriangleCorners SearchedMesh::corners(int triangle) const {
  const Triangle& t = triangles()[static_cast<std::size_t>(triangle)];
  return {vertices_[static_cast<std::size_t>(t[0])], vertices_[static_cast<std::size_t>(t[1])],
          vertices_[static_cast<std::size_t>(t[2])]};
}

double SearchedMesh::solid_angle_of_rim(int node, const Vec3& x) const {
  const std::span<const NodeRims::Edge> rim = rims_->rim(node);
  if (rim.empty()) return 0.0;
  AngleSum half;
  const Vec3 a = vertices_[static_cast<std::size_t>(rim.front()[0])] - x;
  const double la = a.norm();
  for (const NodeRims::Edge& e : rim) {
    const Vec3 b = vertices_[static_cast<std::size_t>(e[0])] - x, c = vertices_[static_cast<std::size_t>(e[1])] - x;
    const double lb = b.norm(), lc = c.norm();
    half.add(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, a.dot(b.cross(c)));  // as solid_angle
  }
  return 2.0 * half.take();
}

double SearchedMesh::winding(const Vec3& x) const {
  if (tree_->is_empty()) return 0.0;
  double sum = 0.0;
  std::vector<int> waiting = {0};
  while (!waiting.empty()) {
    const int n = waiting.back();
    waiting.pop_back();
    const BoxTree::Node& node = tree_->nodes()[static_cast<std::size_t>(n)];
    const double beside = kBeside * node_box(n).extent().norm();
    if (rims_ != nullptr && rims_->has_rim(n) && squared_distance(node_box(n), x) > beside * beside) {
      sum += solid_angle_of_rim(n, x);
    } else if (node.is_leaf()) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const TriangleCorners c = corners(tree_->order()[static_cast<std::size_t>(i)]);
        sum += solid_angle(c[0] - x, c[1] - x, c[2] - x);
      }
    } else {
      waiting.push_back(node.second);
      waiting.push_back(n + 1);
    }
  }
  const double winding = sum / (4.0 * M_PI);
  return std::abs(winding - 0.5) > kUndecided ? winding : winding_number(x, vertices_, triangles());
}

double SearchedMesh::distance(const Vec3& x) const {
  double best = std::numeric_limits<double>::infinity();
  if (tree_->is_empty()) return best;
  std::vector<std::pair<double, int>> waiting = {{0.0, 0}};
  while (!waiting.empty()) {
    const auto [bound, n] = waiting.back();
    waiting.pop_back();
    if (bound > best) continue;
    const BoxTree::Node& node = tree_->nodes()[static_cast<std::size_t>(n)];
    if (!node.is_leaf()) {
      std::pair<double, int> first = {squared_distance(node_box(n + 1), x), n + 1};
      std::pair<double, int> second = {squared_distance(node_box(node.second), x), node.second};
      if (second < first) std::swap(first, second);
      waiting.push_back(second);
      waiting.push_back(first);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      best =
          std::min(best, closest_on_triangle(x, corners(tree_->order()[static_cast<std::size_t>(i)])).squared_distance);
  }
  return std::sqrt(best);
}

double SearchedMesh::way_along(const Vec3& x, const Vec3& direction, double slack, int except) const {
  double way = INFINITY;
  tree_->search(
      [&](int n) {
        const Aabb& box = node_box(n);
        const double room = kParallel * (box.extent().norm() + (box.center() - x).norm());
        return line_meets(box.inflated(room), x, direction);
      },
      [&](int t) {
        if (t == except) return;
        const std::optional<RayHit> hit = intersect_line(x, direction, corners(t), slack);
        if (hit && hit->t > 0.0) way = std::min(way, hit->t);
      });
  return way;
}

std::vector<int> SearchedMesh::triangles_near(const Aabb& region) const {
  std::vector<int> found;
  tree_->search([&](int n) { return overlap(node_box(n), region); },
                [&](int t) {
                  if (overlap(box(t), region)) found.push_back(t);
                });
  return found;
}

std::vector<int> SearchedMesh::vertices_near(const Aabb& region) const {
  std::vector<int> found;
  for (const int t : triangles_near(region))
    for (const int v : triangles()[static_cast<std::size_t>(t)]) found.push_back(v);
  found.insert(found.end(), loose_.begin(), loose_.end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace impinge
