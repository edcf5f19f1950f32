// A box about the origin, its sides along the axes.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {

Box::Box(const Vec3& half_lengths) : ConvexShape("box"), half(half_lengths) {}

const ConvexPolyhedron* Box::polyhedron() const {
  return &solid_.get([&] { return ConvexPolyhedron(make_box_mesh(half)->mesh); });
}

Aabb Box::bounds(const Pose& pose) const {
  const Vec3 reach = pose.rotation.cwiseAbs() * half;
  return {pose.position - reach, pose.position + reach};
}

MassProperties Box::mass(double density) const { return box_mass(half, density); }

double Box::signed_distance(const Vec3& x) const {
  const Vec3 q = x.cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

Vec3 Box::outward(const Vec3& x) const {
  const Vec3 offset = x - x.cwiseMax(-half).cwiseMin(half);
  const double length = offset.norm();
  if (length > 0.0) return offset / length;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (half[k] - std::abs(x[k]) < half[axis] - std::abs(x[axis])) axis = k;
  return x[axis] < 0.0 ? Vec3(-Vec3::Unit(axis)) : Vec3(Vec3::Unit(axis));
}

Vec3 Box::support(const Vec3& direction) const {
  return {direction.x() < 0.0 ? -half.x() : half.x(), direction.y() < 0.0 ? -half.y() : half.y(),
          direction.z() < 0.0 ? -half.z() : half.z()};
}

TriangleMesh Box::surface(double edge) const {
  return box_surface(half, cells_of_box(half, 2.0 * half.maxCoeff() / edge));
}

TriangleMesh Box::drawn() const { return make_box_mesh(half)->mesh; }

MeshPointer make_box_mesh(const Vec3& half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(), (i & 4 ? 1 : -1) * half.z());
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return make_surface(std::move(mesh));
}

Eigen::Vector3i cells_of_box(const Vec3& half, double cells) {
  return (half / half.maxCoeff() * cells).array().round().max(1.0).matrix().cast<int>();
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

ShapeEntry box_shape() {
  return {"box",
          "A box about the origin, its sides along the axes.",
          {{"size", ShapeKey::lengths, "full lengths along x, y, z"}},
          [](const ShapeValues& values) -> SharedShape { return Box(0.5 * values.vector("size")); }};
}

}  // namespace impinge
