#include "engine/geometry/surface/mesh_shells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "engine/geometry/disjoint_sets.hpp"
#include "engine/geometry/surface/surface_side.hpp"

namespace impinge {
namespace {

// of the area to the power of 3/2: a volume below it is rounding
constexpr double kFlat = 1e-12;

/// Number of the shell of each triangle, by the shells' first triangles.
std::vector<int> label_triangles(const TriangleMesh& mesh, const MeshTopology& topology, int& count) {
  DisjointSets shells(mesh.triangles.size());
  for (const MeshTopology::Edge& edge : topology.edges)
    if (edge.triangle1 >= 0) shells.join(edge.triangle0, edge.triangle1);
  std::vector<int> label(mesh.triangles.size(), -1);
  count = 0;
  for (int t = 0; t < static_cast<int>(label.size()); ++t) {
    const int r = shells.root(t);
    if (r == t) label[t] = count++;
    label[t] = label[r];
  }
  return label;
}

/// About a point of the shell: a mesh far from the origin must not lose its volume to cancellation.
double volume_of(const TriangleMesh& mesh, const Shell& shell) {
  const Vec3 origin = shell.box.center();
  double sum = 0.0;
  for (const int t : shell.triangles) {
    const Triangle& v = mesh.triangles[t];
    const Vec3 a = mesh.vertices[v[0]] - origin, b = mesh.vertices[v[1]] - origin, c = mesh.vertices[v[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

double area_of(const TriangleMesh& mesh, const Shell& shell) {
  double sum = 0.0;
  for (const int t : shell.triangles) {
    const Triangle& v = mesh.triangles[t];
    const Vec3& a = mesh.vertices[v[0]];
    sum += 0.5 * (mesh.vertices[v[1]] - a).cross(mesh.vertices[v[2]] - a).norm();
  }
  return sum;
}

std::vector<int> vertices_of(const TriangleMesh& mesh, const Shell& shell) {
  std::vector<int> vertices;
  for (const int t : shell.triangles)
    vertices.insert(vertices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

bool holds(const Aabb& outer, const Aabb& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

class Nesting {
 public:
  Nesting(const TriangleMesh& mesh, std::vector<Shell>& shells)
      : mesh_(mesh), shells_(shells), sides_(shells.size()), vertices_(shells.size()) {}

  void find() {
    // by their lower x: whatever contains a shell begins before it and has not ended
    std::vector<int> order(shells_.size()), open;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int l, int r) {
      const double a = shells_[l].box.min.x(), b = shells_[r].box.min.x();
      return a != b ? a < b : l < r;
    });
    std::vector<std::vector<int>> containers(shells_.size());
    std::size_t same = 0;  // those that begin at the same x may contain one another in either order
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Shell& shell = shells_[order[i]];
      std::erase_if(open, [&](int k) { return shells_[k].box.max.x() < shell.box.min.x(); });
      for (same = std::max(same, i); same < order.size() && shells_[order[same]].box.min.x() == shell.box.min.x();
           ++same)
        open.push_back(order[same]);
      for (const int k : open)
        if (k != order[i] && contains(k, order[i])) containers[order[i]].push_back(k);
    }
    for (std::size_t i = 0; i < shells_.size(); ++i) shells_[i].depth = static_cast<int>(containers[i].size());
    for (std::size_t i = 0; i < shells_.size(); ++i)
      for (const int k : containers[i])
        if (shells_[i].container < 0 || shells_[k].depth > shells_[shells_[i].container].depth)
          shells_[i].container = k;
  }

 private:
  const SurfaceSide& side(int shell) {
    if (sides_[shell] == nullptr) {
      std::vector<Triangle> triangles;
      for (const int t : shells_[shell].triangles) triangles.push_back(mesh_.triangles[t]);
      sides_[shell] = std::make_unique<SurfaceSide>(mesh_.vertices, std::move(triangles));
    }
    return *sides_[shell];
  }

  const std::vector<int>& vertices(int shell) {
    if (vertices_[shell].empty()) vertices_[shell] = vertices_of(mesh_, shells_[shell]);
    return vertices_[shell];
  }

  bool contains(int outer, int inner) {
    if (!holds(shells_[outer].box, shells_[inner].box)) return false;
    bool some_inside = false;
    const auto outside = [&](const Vec3& x) {
      const std::optional<int> number = side(outer).winding(x);
      some_inside |= number && *number != 0;
      return number && *number == 0;
    };
    for (const int v : vertices(inner))
      if (outside(mesh_.vertices[v])) return false;
    for (const int t : shells_[inner].triangles) {
      if (some_inside) break;  // the midpoints are for shells whose vertices all touch the other
      const Triangle& c = mesh_.triangles[t];
      if (outside((mesh_.vertices[c[0]] + mesh_.vertices[c[1]] + mesh_.vertices[c[2]]) / 3.0)) return false;
    }
    if (!some_inside) return false;
    const Aabb& box = shells_[inner].box;
    for (const int v : vertices(outer)) {
      const Vec3& x = mesh_.vertices[v];
      if ((x.array() < box.min.array()).any() || (x.array() > box.max.array()).any()) continue;
      const std::optional<int> number = side(inner).winding(x);
      if (number && *number != 0) return false;
    }
    return true;
  }

  const TriangleMesh& mesh_;
  std::vector<Shell>& shells_;
  std::vector<std::unique_ptr<SurfaceSide>> sides_;  // made when they are asked
  std::vector<std::vector<int>> vertices_;
};

}  // namespace

std::vector<Shell> find_shells(const TriangleMesh& mesh, const MeshTopology& topology) {
  int count = 0;
  const std::vector<int> label = label_triangles(mesh, topology, count);
  std::vector<Shell> shells(static_cast<std::size_t>(count));
  for (int t = 0; t < static_cast<int>(label.size()); ++t) {
    Shell& shell = shells[label[t]];
    shell.triangles.push_back(t);
    for (const int v : mesh.triangles[t]) shell.box.include(mesh.vertices[v]);
  }
  for (Shell& shell : shells) shell.volume = volume_of(mesh, shell);
  if (count > 1) Nesting(mesh, shells).find();
  return shells;
}

std::optional<std::string> check_shells(const TriangleMesh& mesh, const MeshTopology& topology) {
  const std::vector<Shell> shells = find_shells(mesh, topology);
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const Shell& shell = shells[i];
    const bool outward = shell.depth % 2 == 0;
    if (outward == (shell.volume > 0.0)) continue;
    if (std::abs(shell.volume) <= kFlat * std::pow(area_of(mesh, shell), 1.5)) continue;
    if (shells.size() == 1)
      return fmt::format(
          "is inside out: its triangles face inwards (volume {:.6g} m³); flip the order of each triangle's corners",
          shell.volume);
    const std::string which = fmt::format("has component {} of {} inside out (triangles from {} on, volume {:.6g} m³)",
                                          i + 1, shells.size(), shell.triangles.front(), shell.volume);
    if (shell.container < 0)
      return which + ": its triangles face inwards, an outer wall's face outwards; flip the order of their corners";
    if (outward)
      return fmt::format(
          "{}: its triangles face inwards, but it stands in the cavity of component {}, where a solid's face outwards; "
          "flip the order of their corners",
          which, shell.container + 1);
    return fmt::format(
        "{}: it lies inside component {}, where it is the wall of a cavity, and its triangles face outwards; flip the "
        "order of their corners, or remove it if no cavity is meant",
        which, shell.container + 1);
  }
  return std::nullopt;
}

}  // namespace impinge
