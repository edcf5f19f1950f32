#include "engine/geometry/nearest_triangle.hpp"

#include <limits>

namespace impinge {

NearestTriangle nearest_triangle(const BoxTree& tree, std::span<const Triangle> triangles,
                                 std::span<const Vec3> vertices, const Vec3& x, std::span<const Aabb> fitted,
                                 int guess) {
  NearestTriangle best;
  best.at.squared_distance = std::numeric_limits<double>::infinity();
  if (tree.is_empty()) return best;
  const auto look_at = [&](int t) {
    const Triangle& c = triangles[t];
    const PointTriangle p = closest_on_triangle(x, {vertices[c[0]], vertices[c[1]], vertices[c[2]]});
    if (p.squared_distance < best.at.squared_distance) best = {t, p};
  };
  if (guess >= 0) look_at(guess);
  const auto bound_of = [&](int n) { return squared_distance(fitted.empty() ? tree.nodes()[n].box : fitted[n], x); };
  std::vector<std::pair<double, int>> waiting = {{0.0, 0}};
  while (!waiting.empty()) {
    const auto [bound, n] = waiting.back();
    waiting.pop_back();
    if (bound >= best.at.squared_distance) continue;
    const BoxTree::Node& node = tree.nodes()[n];
    if (!node.is_leaf()) {
      std::pair<double, int> first = {bound_of(n + 1), n + 1}, second = {bound_of(node.second), node.second};
      if (second < first) std::swap(first, second);
      waiting.push_back(second);  // the nearer one is looked at first, so that the farther can be left out
      waiting.push_back(first);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) look_at(tree.order()[i]);
  }
  return best;
}

}  // namespace impinge
