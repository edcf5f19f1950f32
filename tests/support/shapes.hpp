// Shapes, colliders and round meshes for tests.
#pragma once

#include <deque>
#include <map>

#include "engine/bodies/collider.hpp"
#include "engine/contact/collision.hpp"
#include "engine/narrowphase/primitive.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// Icosahedron split `splits` times, corners on the sphere of that radius: 20 * 4^splits triangles.
inline TriangleMesh icosphere(int splits, double radius) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (int k = 0; k < splits; ++k) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto found = middles.find(key);
      if (found != middles.end()) return found->second;
      const Vec3 point = 0.5 * (mesh.vertices[a] + mesh.vertices[b]);
      mesh.vertices.push_back(point);
      return middles[key] = static_cast<int>(mesh.vertices.size()) - 1;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {Triangle{t[0], ab, ca}, Triangle{ab, t[1], bc}, Triangle{ca, bc, t[2]}, Triangle{ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
    for (Vec3& v : mesh.vertices) v.normalize();
  }
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

/// A box whose faces are cut into n x n squares of two triangles each; closed.
inline TriangleMesh gridded_box(const Vec3& half, int n) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](std::array<int, 3> c) {
    const auto [it, fresh] = index.try_emplace(c, static_cast<int>(mesh.vertices.size()));
    if (fresh) {
      Vec3 v;
      for (int k = 0; k < 3; ++k) v[k] = half[k] * (2.0 * c[k] / n - 1.0);
      mesh.vertices.push_back(v);
    }
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int di, int dj) {
            std::array<int, 3> c{};
            c[axis] = side * n;
            c[(axis + 1) % 3] = i + di;
            c[(axis + 2) % 3] = j + dj;
            return vertex(c);
          };
          const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          if (side == 1)
            mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {Triangle{a, c, b}, Triangle{a, d, c}});
        }
  return mesh;
}

inline MeshPointer make_surface(TriangleMesh mesh) {
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = std::move(mesh);
  surface->topology = make_topology(surface->mesh);
  return surface;
}

/// Owns what colliders point to. Bodies are numbered in the order in which they are added.
class Bodies {
 public:
  Collider& add(const Shape& shape, const Pose& pose = {}) {
    shapes_.push_back(shape);
    Collider c;
    c.shape = &shapes_.back();
    colliders_.push_back(c);
    vertices_.emplace_back();
    place(static_cast<int>(colliders_.size()) - 1, pose);
    return colliders_.back();
  }
  void place(int i, const Pose& pose) {
    Collider& c = colliders_[i];
    c.pose = pose;
    c.bounds = shape_bounds(*c.shape, pose);
    if (!is_mesh(*c.shape)) return;
    vertices_[i].clear();
    for (const Vec3& v : c.mesh().mesh.vertices) vertices_[i].push_back(pose.apply(v));
    c.vertices = vertices_[i];
    c.mean_edge = mean_edge_length(c.mesh().mesh);
  }
  Collider& operator[](int i) { return colliders_[i]; }
  std::span<const Collider> colliders() const { return colliders_; }
  std::vector<Collision> contacts(int a, int b, const ContactQuery& query) const {
    std::vector<Collision> found;
    primitive_contacts(colliders_, BodyPair{a, b, query.activation}, query, found);
    return found;
  }

 private:
  std::deque<Shape> shapes_;
  std::deque<std::vector<Vec3>> vertices_;
  std::vector<Collider> colliders_;
};

inline Pose random_pose(Random& random, double spread) {
  Pose pose;
  pose.rotation = random.rotation();
  pose.position = spread * random.vector();
  return pose;
}

inline Pose then(const Pose& outer, const Pose& inner) { return {outer.rotation * inner.rotation, outer.apply(inner.position)}; }

inline double smallest_gap(const std::vector<Collision>& contacts) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Collision& c : contacts) gap = std::min(gap, c.gap);
  return gap;
}

}  // namespace impinge::test
