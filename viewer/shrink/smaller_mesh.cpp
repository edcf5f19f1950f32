#include "viewer/shrink/smaller_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/convex/convex_hull.hpp"
#include "engine/geometry/mend/remesh.hpp"

namespace impinge {

namespace {

constexpr int kCells[] = {4, 8, 16, 32};
constexpr std::size_t kMostRemeshed = 200'000;  // triangles: a skin takes longer than what is saved

TriangleMesh box_of(const Aabb& box) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
                               (i & 4) != 0 ? box.max.z() : box.min.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// The vertices of a cell become the first of them; triangles that lose a corner by it, or are there already, go.
TriangleMesh clustered(const TriangleMesh& mesh, const Aabb& box, int cells) {
  const double cell = box.extent().maxCoeff() / cells;
  std::map<std::array<long, 3>, int> first;
  std::vector<int> to(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 at = (mesh.vertices[v] - box.min) / cell;
    const std::array<long, 3> key = {std::lround(at.x()), std::lround(at.y()), std::lround(at.z())};
    to[v] = first.try_emplace(key, static_cast<int>(v)).first->second;
  }
  std::set<std::array<int, 3>> there;
  std::vector<int> kept;
  TriangleMesh merged = mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle& triangle = merged.triangles[t];
    for (int& v : triangle) v = to[static_cast<std::size_t>(v)];
    std::array<int, 3> corners = {triangle[0], triangle[1], triangle[2]};
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2] || !there.insert(corners).second) continue;
    kept.push_back(static_cast<int>(t));
  }
  return with_triangles(merged, kept);
}

}  // namespace

std::vector<std::vector<int>> connected_parts(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      int& up = parent[static_cast<std::size_t>(v)];
      v = up = parent[static_cast<std::size_t>(up)];
    }
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (const int k : {1, 2}) parent[static_cast<std::size_t>(root(t[k]))] = root(t[0]);
  std::map<int, std::size_t> part_of;
  std::vector<std::vector<int>> parts;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [it, is_new] = part_of.try_emplace(root(mesh.triangles[t][0]), parts.size());
    if (is_new) parts.emplace_back();
    parts[it->second].push_back(static_cast<int>(t));
  }
  return parts;
}

TriangleMesh with_triangles(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  TriangleMesh part;
  std::vector<int> place(mesh.vertices.size(), -1);
  for (const int t : triangles) {
    Triangle triangle = mesh.triangles[static_cast<std::size_t>(t)];
    for (int& v : triangle) {
      int& to = place[static_cast<std::size_t>(v)];
      if (to < 0) {
        to = static_cast<int>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = to;
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

std::vector<TriangleMesh> smaller_meshes(const TriangleMesh& mesh) {
  Aabb box;
  for (const Vec3& x : mesh.vertices) box.include(x);
  std::vector<TriangleMesh> all;
  if (box.extent().minCoeff() > 0.0) all.push_back(box_of(box));
  all.push_back(convex_hull(mesh.vertices).mesh);
  const bool is_closed = make_topology(mesh).is_closed() && mesh.triangles.size() <= kMostRemeshed;
  for (const int cells : kCells) {
    all.push_back(clustered(mesh, box, cells));
    if (is_closed) all.push_back(remesh(mesh, {}, cells, nullptr));
  }
  std::erase_if(
      all, [&](const TriangleMesh& m) { return m.triangles.empty() || m.triangles.size() >= mesh.triangles.size(); });
  std::stable_sort(all.begin(), all.end(), [](const TriangleMesh& a, const TriangleMesh& b) {
    return a.triangles.size() < b.triangles.size();
  });
  return all;
}

}  // namespace impinge
