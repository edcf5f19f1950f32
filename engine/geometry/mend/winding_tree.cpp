#include "engine/geometry/mend/winding_tree.hpp"

#include <cmath>

namespace impinge {
namespace {

constexpr int kLeaf = 8;
constexpr double kFar = 3.0;  // reaches: from there on a part is a dipole

double solid_angle(const Vec3& x, const Vec3& p, const Vec3& q, const Vec3& r) {  // [VanOosterom83]
  const Vec3 a = p - x, b = q - x, c = r - x;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

WindingTree::WindingTree(std::span<const Triangle> triangles, std::span<const Vec3> vertices)
    : triangles_(triangles), vertices_(vertices), tree_(triangle_boxes(triangles, vertices), kLeaf) {
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  dipoles_.resize(nodes.size());
  std::vector<double> area(nodes.size(), 0.0);
  for (std::size_t n = nodes.size(); n-- > 0;) {  // children come after their parents
    Dipole& own = dipoles_[n];
    Vec3 weighted = Vec3::Zero();
    const auto add = [&](const Vec3& center, const Vec3& moment, double its_area) {
      own.moment += moment;
      weighted += its_area * center;
      area[n] += its_area;
    };
    if (nodes[n].is_leaf()) {
      for (int i = nodes[n].first; i < nodes[n].first + nodes[n].count; ++i) {
        const Triangle& t = triangles_[tree_.order()[i]];
        const Vec3 &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
        const Vec3 moment = 0.5 * (b - a).cross(c - a);
        add((a + b + c) / 3.0, moment, moment.norm());
      }
    } else {
      for (const std::size_t child : {n + 1, static_cast<std::size_t>(nodes[n].second)})
        add(dipoles_[child].center, dipoles_[child].moment, area[child]);
    }
    own.center = area[n] > 0.0 ? Vec3(weighted / area[n]) : nodes[n].box.center();
    const Aabb& box = nodes[n].box;
    own.reach = (own.center - box.min).cwiseAbs().cwiseMax((box.max - own.center).cwiseAbs()).norm();
  }
}

double WindingTree::at(const Vec3& x) const {
  double sum = 0.0;
  if (tree_.is_empty()) return sum;
  // a tree of n triangles has no more than 2 n nodes and is walked depth first: what waits is one node a level
  thread_local std::vector<int> waiting;
  waiting.assign(1, 0);
  while (!waiting.empty()) {
    const int n = waiting.back();
    waiting.pop_back();
    const Dipole& dipole = dipoles_[n];
    const Vec3 to = dipole.center - x;
    const double distance_sq = to.squaredNorm();
    if (distance_sq > kFar * kFar * dipole.reach * dipole.reach) {
      sum += dipole.moment.dot(to) / (distance_sq * std::sqrt(distance_sq));
      continue;
    }
    const BoxTree::Node& node = tree_.nodes()[n];
    if (node.is_leaf()) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const Triangle& t = triangles_[tree_.order()[i]];
        sum += solid_angle(x, vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
      }
    } else {
      waiting.push_back(node.second);
      waiting.push_back(n + 1);
    }
  }
  return sum / (4.0 * M_PI);
}

}  // namespace impinge
