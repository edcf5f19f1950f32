#include "engine/geometry/mend/fill_holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostBest = 800;  // corners of a border whose best filling is looked for: n³ / 6 steps
constexpr double kShape = 1e-4;         // what an edge's square counts beside area: among equal areas short edges win

/// Edges that are there, and those that fillings add: none may get a third triangle.
class KnownEdges {
 public:
  explicit KnownEdges(const MeshTopology& topology) {
    for (const MeshTopology::Edge& edge : topology.edges) add(edge.v0, edge.v1);
  }
  bool has(int a, int b) const { return known_.count(key(a, b)) != 0; }
  void add(int a, int b) { known_.insert(key(a, b)); }

 private:
  static std::uint64_t key(int a, int b) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(std::min(a, b))) << 32 |
           static_cast<std::uint32_t>(std::max(a, b));
  }
  std::unordered_set<std::uint64_t> known_;
};

class Filler {
 public:
  Filler(const TriangleMesh& mesh, const MeshTopology& topology) : mesh_(mesh), edges_(topology) {}

  void fill(Hole& hole) {
    hole_ = &hole;
    if (hole.border.size() > kMostBest || !fill_best()) fill_by_ears();
    for (const Triangle& t : hole.filling) {
      hole.area += 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
      for (int k = 0; k < 3; ++k) edges_.add(t[k], t[(k + 1) % 3]);
    }
  }

 private:
  int vertices() const { return static_cast<int>(mesh_.vertices.size()); }
  const Vec3& at(int v) const { return v < vertices() ? mesh_.vertices[v] : hole_->new_vertices[v - vertices()]; }
  double cost(int a, int b, int c) const {
    const Vec3 ab = at(b) - at(a), ac = at(c) - at(a);
    return 0.5 * ab.cross(ac).norm() + kShape * (ab.squaredNorm() + ac.squaredNorm() + (at(c) - at(b)).squaredNorm());
  }

  /// Over all triangulations of the border as a polygon, from short pieces of it to long ones.
  bool fill_best() {
    const std::vector<int>& border = hole_->border;
    const int n = static_cast<int>(border.size());
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<double> least(static_cast<std::size_t>(n) * n, 0.0);
    std::vector<int> middle(least.size(), -1);
    const auto slot = [n](int i, int j) { return static_cast<std::size_t>(i) * n + j; };
    for (int length = 2; length < n; ++length) {
      check_interrupt();
      for (int i = 0; i + length < n; ++i) {
        const int j = i + length;
        double& best = least[slot(i, j)];
        best = kNever;
        if (length < n - 1 && edges_.has(border[i], border[j])) continue;
        for (int k = i + 1; k < j; ++k) {
          const double sum = least[slot(i, k)] + least[slot(k, j)] + cost(border[i], border[k], border[j]);
          if (sum < best) best = sum, middle[slot(i, j)] = k;
        }
      }
    }
    if (!(least[slot(0, n - 1)] < kNever)) return false;
    std::vector<std::pair<int, int>> open = {{0, n - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j - i < 2) continue;
      const int k = middle[slot(i, j)];
      hole_->filling.push_back({border[i], border[k], border[j]});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
    return true;
  }

  /// Cuts off the ear with the shortest new edge, again and again; what can't be cut so gets a middle.
  void fill_by_ears() {
    hole_->filling.clear();
    const std::vector<int>& border = hole_->border;
    const int n = static_cast<int>(border.size());
    std::vector<int> next(n), last(n);
    for (int i = 0; i < n; ++i) next[i] = (i + 1) % n, last[i] = (i + n - 1) % n;
    std::set<std::pair<double, int>> ears;  // by the new edge's length
    const auto ear = [&](int i) { return std::pair((at(border[next[i]]) - at(border[last[i]])).squaredNorm(), i); };
    for (int i = 0; i < n; ++i) ears.insert(ear(i));
    int left = n;
    std::set<std::pair<double, int>> blocked;  // their edge is another's
    InterruptPoll poll;
    while (left > 3 && !ears.empty()) {
      poll();
      const int i = ears.begin()->second;
      if (edges_.has(border[last[i]], border[next[i]])) {
        blocked.insert(*ears.begin());
        ears.erase(ears.begin());
        continue;
      }
      for (const int k : {last[i], i, next[i]}) ears.erase(ear(k)), blocked.erase(ear(k));
      hole_->filling.push_back({border[last[i]], border[i], border[next[i]]});
      edges_.add(border[last[i]], border[next[i]]);
      next[last[i]] = next[i];
      last[next[i]] = last[i];
      for (const int k : {last[i], next[i]}) ears.insert(ear(k));
      --left;
    }
    std::vector<int> rest;
    int start = 0;
    if (!ears.empty())
      start = ears.begin()->second;
    else if (!blocked.empty())
      start = blocked.begin()->second;
    for (int i = start; rest.empty() || i != start; i = next[i]) rest.push_back(border[i]);
    if (rest.size() == 3) {
      hole_->filling.push_back({rest[0], rest[1], rest[2]});
      return;
    }
    Vec3 mean = Vec3::Zero();
    for (const int v : rest) mean += at(v) / static_cast<double>(rest.size());
    const int middle = vertices() + static_cast<int>(hole_->new_vertices.size());
    hole_->new_vertices.push_back(mean);
    for (std::size_t i = 0; i < rest.size(); ++i)
      hole_->filling.push_back({rest[i], rest[(i + 1) % rest.size()], middle});
  }

  const TriangleMesh& mesh_;
  KnownEdges edges_;
  Hole* hole_ = nullptr;
};

}  // namespace

std::vector<Hole> find_holes(const TriangleMesh& mesh, const MeshTopology& topology) {
  // the filling runs along an edge against the triangle that is there
  std::vector<int> follows(mesh.vertices.size(), -1);
  for (const MeshTopology::Edge& edge : topology.edges) {
    if (edge.triangle1 >= 0) continue;
    const bool up = runs_along(mesh.triangles[edge.triangle0], edge.v0, edge.v1);
    follows[up ? edge.v1 : edge.v0] = up ? edge.v0 : edge.v1;
  }
  std::vector<Hole> holes;
  std::vector<char> seen(follows.size(), 0);
  for (int v = 0; v < static_cast<int>(follows.size()); ++v) {
    if (follows[v] < 0 || seen[v] != 0) continue;
    Hole hole;
    int at = v;
    for (; at >= 0 && seen[at] == 0; at = follows[at]) seen[at] = 1, hole.border.push_back(at);
    if (at == v && hole.border.size() >= 3) holes.push_back(std::move(hole));
  }
  Filler filler(mesh, topology);
  for (Hole& hole : holes) filler.fill(hole);
  return holes;
}

void fill(TriangleMesh& mesh, std::span<const Hole> holes) {
  const int given = static_cast<int>(mesh.vertices.size());
  for (const Hole& hole : holes) {
    const int shift = static_cast<int>(mesh.vertices.size()) - given;
    mesh.vertices.insert(mesh.vertices.end(), hole.new_vertices.begin(), hole.new_vertices.end());
    for (Triangle t : hole.filling) {
      for (int& v : t) v += v >= given ? shift : 0;
      mesh.triangles.push_back(t);
    }
  }
}

}  // namespace impinge
