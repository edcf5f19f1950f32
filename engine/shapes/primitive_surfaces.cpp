#include "engine/shapes/primitive_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace impinge {

TriangleMesh sphere_surface(double radius, int k) {
  // golden section: the icosahedron's corners are (0, ±1, ±g) and cyclic
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < k; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto half_way = [&](int a, int b) {
      const auto [at, is_new] = middle.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(mesh.vertices[a] + mesh.vertices[b]);
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      const int a = half_way(t[0], t[1]), b = half_way(t[1], t[2]), c = half_way(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
    for (Vec3& v : mesh.vertices) v.normalize();
  }
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

TriangleMesh box_surface(const Vec3& half, const Eigen::Vector3i& cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = index.try_emplace(at, static_cast<int>(mesh.vertices.size()));
    if (is_new) {
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = half[k] * (2.0 * at[k] / cells[k] - 1.0);
      mesh.vertices.push_back(x);
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;  // u × v = axis
    for (const int side : {0, cells[axis]})
      for (int i = 0; i < cells[u]; ++i)
        for (int j = 0; j < cells[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at;
            at[axis] = side, at[u] = i + di, at[v] = j + dj;
            return vertex(at);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0)
            mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        }
  }
  return mesh;
}

TriangleMesh capsule_surface(double radius, double half_length, int around) {
  const double edge = 2.0 * std::numbers::pi * radius / around;
  const int cap = std::max(2, (around + 2) / 4),
            side = std::max(1, static_cast<int>(std::lround(2.0 * half_length / edge)));
  std::vector<Vec2> profile;  // distance from the axis and y of each ring, poles left out, from below
  for (int i = 1; i <= cap; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / cap;
    profile.emplace_back(radius * std::sin(angle), -half_length - radius * std::cos(angle));
  }
  for (int i = 1; i < side; ++i) profile.emplace_back(radius, half_length * (2.0 * i / side - 1.0));
  for (int i = cap; i >= 1; --i) {
    const double angle = 0.5 * std::numbers::pi * i / cap;
    profile.emplace_back(radius * std::sin(angle), half_length + radius * std::cos(angle));
  }
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0.0, -half_length - radius, 0.0);
  for (const Vec2& ring : profile)
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / around;
      mesh.vertices.emplace_back(ring.x() * std::cos(angle), ring.y(), -ring.x() * std::sin(angle));
    }
  const int top = static_cast<int>(mesh.vertices.size()), rings = static_cast<int>(profile.size());
  mesh.vertices.emplace_back(0.0, half_length + radius, 0.0);
  const auto at = [&](int ring, int k) { return 1 + ring * around + k % around; };
  for (int k = 0; k < around; ++k) {
    mesh.triangles.push_back({0, at(0, k + 1), at(0, k)});
    for (int r = 0; r + 1 < rings; ++r)
      mesh.triangles.insert(mesh.triangles.end(),
                            {{at(r, k), at(r, k + 1), at(r + 1, k + 1)}, {at(r, k), at(r + 1, k + 1), at(r + 1, k)}});
    mesh.triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), top});
  }
  return mesh;
}

}  // namespace impinge
