#include "viewer/draw/tessellation.hpp"

#include <cmath>
#include <map>

#include "engine/core/error.hpp"

namespace impinge {
namespace {

constexpr int kSphereDivisions = 3;   // 20 * 4^3 = 1280 triangles
constexpr int kCapsuleSegments = 32;  // round the axis
constexpr int kCapsuleRings = 8;      // from the equator of a cap to its pole

/// An icosahedron divided: nearly equal triangles, no poles.
TriangleMesh sphere(double radius) {
  const double t = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : mesh.vertices) v.normalize();
  for (int division = 0; division < kSphereDivisions; ++division) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& v : mesh.vertices) v *= radius;
  return mesh;
}

/// Rings of vertices from the upper pole (+y) to the lower one.
TriangleMesh capsule(const Capsule& shape) {
  TriangleMesh mesh;
  const int rings = 2 * kCapsuleRings, n = kCapsuleSegments;  // the two equators included, the poles not
  mesh.vertices.push_back({0.0, shape.half_length + shape.radius, 0.0});
  for (int i = 0; i < rings; ++i) {
    const bool upper = i < kCapsuleRings;
    const double angle = 0.5 * M_PI * (upper ? i + 1 : rings - i) / kCapsuleRings;  // from the cap's own pole
    const double r = shape.radius * std::sin(angle);
    const double y = (upper ? 1.0 : -1.0) * (shape.half_length + shape.radius * std::cos(angle));
    for (int k = 0; k < n; ++k)
      mesh.vertices.push_back({r * std::sin(2.0 * M_PI * k / n), y, r * std::cos(2.0 * M_PI * k / n)});
  }
  mesh.vertices.push_back({0.0, -shape.half_length - shape.radius, 0.0});
  const auto at = [&](int ring, int k) { return 1 + ring * n + k % n; };
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  for (int k = 0; k < n; ++k) mesh.triangles.push_back({0, at(0, k), at(0, k + 1)});
  for (int i = 0; i + 1 < rings; ++i)
    for (int k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  for (int k = 0; k < n; ++k) mesh.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
  return mesh;
}

}  // namespace

TriangleMesh tessellate(const Shape& shape) {
  if (const auto* s = std::get_if<Sphere>(&shape)) return sphere(s->radius);
  if (const auto* s = std::get_if<Box>(&shape)) return make_box_mesh(s->half)->mesh;
  // without length the two equators would be one ring and the wall between them triangles without area
  if (const auto* s = std::get_if<Capsule>(&shape)) return s->half_length > 0.0 ? capsule(*s) : sphere(s->radius);
  if (const auto* s = std::get_if<MeshPointer>(&shape)) return (*s)->mesh;
  throw InternalError("a plane has no finite surface to tessellate");
}

}  // namespace impinge
