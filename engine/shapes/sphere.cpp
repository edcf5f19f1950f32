// A ball: for contact a point with a radius.
#include <cmath>
#include <map>

#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {

Sphere::Sphere(double metres) : ConvexShape("sphere"), radius(metres) {}

Aabb Sphere::bounds(const Pose& pose) const {
  return {pose.position - Vec3::Constant(radius), pose.position + Vec3::Constant(radius)};
}

MassProperties Sphere::mass(double density) const { return sphere_mass(radius, density); }

TriangleMesh Sphere::surface(double edge) const {
  int k = 1;  // an icosphere's edges are about 1.1 r / 2^k long
  while (k < 5 && 1.1 * radius / (1 << k) > edge) ++k;
  return sphere_surface(radius, k);
}

TriangleMesh Sphere::drawn() const { return sphere_surface(radius, 3); }

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

ShapeEntry sphere_shape() {
  return {"sphere",
          "A ball about the origin.",
          {{"radius", ShapeKey::length, "of the ball"}},
          [](const ShapeValues& values) -> SharedShape { return Sphere(values.number("radius")); }};
}

}  // namespace impinge
