#include "engine/geometry/mend/split_borders.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/box_tree.hpp"

namespace impinge {
namespace {

constexpr int kMostRounds = 8;  // a round splits one side of a triangle

class BorderSplitter {
 public:
  BorderSplitter(TriangleMesh& mesh, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), topology_(make_topology(mesh)), neighbours_(mesh.vertices.size()) {
    std::vector<Aabb> boxes;
    for (int e = 0; e < static_cast<int>(topology_.edges.size()); ++e) {
      const MeshTopology::Edge& edge = topology_.edges[e];
      if (edge.triangle1 >= 0) continue;
      border_.push_back(e);
      Aabb& box = boxes.emplace_back();
      box.include(mesh.vertices[edge.v0]);
      box.include(mesh.vertices[edge.v1]);
      neighbours_[edge.v0].push_back(edge.v1);
      neighbours_[edge.v1].push_back(edge.v0);
    }
    tree_ = BoxTree(boxes);
  }

  SplitBorders run() {
    SplitBorders done;
    const std::vector<std::vector<int>> on = vertices_on_edges();
    std::vector<char> is_split(mesh_.triangles.size(), 0);
    for (std::size_t i = 0; i < border_.size(); ++i) {
      const MeshTopology::Edge& edge = topology_.edges[border_[i]];
      if (is_split[edge.triangle0] != 0) continue;
      const std::vector<int> at = along(edge, on[i]);
      if (at.empty()) continue;
      is_split[edge.triangle0] = 1;
      ++done.edges;
      for (const int v : at) done.largest_move = std::max(done.largest_move, distance(edge, v));
      split(edge, at);
    }
    return done;
  }

 private:
  const Vec3& at(int v) const { return mesh_.vertices[v]; }

  /// Of its way from v0 to v1.
  double share(const MeshTopology::Edge& edge, int v) const {
    const Vec3 d = at(edge.v1) - at(edge.v0);
    return (at(v) - at(edge.v0)).dot(d) / d.squaredNorm();
  }
  double distance(const MeshTopology::Edge& edge, int v) const {
    return (at(v) - at(edge.v0) - share(edge, v) * (at(edge.v1) - at(edge.v0))).norm();
  }
  bool lies_on(const MeshTopology::Edge& edge, int v) const {
    if (v == edge.v0 || v == edge.v1) return false;
    const double length = (at(edge.v1) - at(edge.v0)).norm(), end = tolerance_ / length, s = share(edge, v);
    return length > 2.0 * tolerance_ && s > end && s < 1.0 - end && distance(edge, v) <= tolerance_;
  }

  std::vector<std::vector<int>> vertices_on_edges() const {
    std::vector<std::vector<int>> on(border_.size());
    InterruptPoll poll;
    for (int v = 0; v < static_cast<int>(neighbours_.size()); ++v) {
      if (neighbours_[v].empty()) continue;
      poll();
      Aabb box;
      box.include(at(v) - Vec3::Constant(tolerance_));
      box.include(at(v) + Vec3::Constant(tolerance_));
      tree_.search([&](int n) { return overlap(tree_.nodes()[n].box, box); },
                   [&](int i) {
                     if (lies_on(topology_.edges[border_[i]], v)) on[i].push_back(v);
                   });
    }
    return on;
  }

  /// Those whose border runs along the edge too, from v0 to v1: a vertex that only touches it is none of its own.
  std::vector<int> along(const MeshTopology::Edge& edge, const std::vector<int>& on) const {
    std::vector<int> found;
    const auto is_near = [&](int w) {
      return w == edge.v0 || w == edge.v1 || std::binary_search(on.begin(), on.end(), w);
    };
    for (const int v : on)
      if (std::any_of(neighbours_[v].begin(), neighbours_[v].end(), is_near)) found.push_back(v);
    std::sort(found.begin(), found.end(), [&](int l, int r) {
      const double sl = share(edge, l), sr = share(edge, r);
      return sl != sr ? sl < sr : l < r;
    });
    return found;
  }

  /// The edge's triangle becomes a fan round its far corner.
  void split(const MeshTopology::Edge& edge, std::vector<int> points) {
    Triangle& own = mesh_.triangles[edge.triangle0];
    points.insert(points.begin(), edge.v0);
    points.push_back(edge.v1);
    if (!runs_along(own, edge.v0, edge.v1)) std::reverse(points.begin(), points.end());
    const auto is_far = [&](int v) { return v != edge.v0 && v != edge.v1; };
    const int far = *std::find_if(own.begin(), own.end(), is_far);
    own = {points[0], points[1], far};
    for (std::size_t i = 1; i + 1 < points.size(); ++i) mesh_.triangles.push_back({points[i], points[i + 1], far});
  }

  TriangleMesh& mesh_;
  double tolerance_;
  MeshTopology topology_;
  std::vector<int> border_;                   // edges
  std::vector<std::vector<int>> neighbours_;  // along borders, by vertex
  BoxTree tree_;
};

}  // namespace

SplitBorders split_borders(TriangleMesh& mesh, double tolerance) {
  SplitBorders sum;
  if (!(tolerance > 0.0)) return sum;
  for (int round = 0; round < kMostRounds; ++round) {
    const SplitBorders done = BorderSplitter(mesh, tolerance).run();
    if (done.edges == 0) break;
    sum.edges += done.edges;
    sum.largest_move = std::max(sum.largest_move, done.largest_move);
  }
  return sum;
}

}  // namespace impinge
