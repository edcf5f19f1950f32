// Colliders of any shape for tests.
#pragma once

#include <deque>

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/pairs/primitive.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// Of a triangle of a mesh, where it is now.
inline TriangleCorners corners(const Collider& c, int triangle) {
  const Triangle& v = c.mesh().mesh.triangles[triangle];
  return {c.vertices[v[0]], c.vertices[v[1]], c.vertices[v[2]]};
}

/// Owns what colliders point to. Bodies are numbered in the order in which they are added.
class TestColliders {
 public:
  // poses by value: they may be those of a collider that moves in memory
  Collider& add(const SharedShape& shape, Pose pose = {}) {
    shapes_.push_back(shape);
    Collider c;
    c.shape = shapes_.back().get();
    colliders_.push_back(c);
    vertices_.emplace_back();
    place(static_cast<int>(colliders_.size()) - 1, pose);
    return colliders_.back();
  }
  void place(int i, Pose pose) {
    Collider& c = colliders_[i];
    c.pose = pose;
    c.bounds = c.shape->bounds(pose);
    if (c.shape->mesh() == nullptr) return;
    vertices_[i].clear();
    for (const Vec3& v : c.mesh().mesh.vertices) vertices_[i].push_back(pose.apply(v));
    c.vertices = vertices_[i];
    c.mean_edge = mean_edge_length(c.mesh().mesh);
  }
  Collider& operator[](int i) { return colliders_[i]; }
  std::span<const Collider> colliders() const { return colliders_; }
  std::vector<Collision> contacts(int a, int b, const ContactQuery& query) const {
    std::vector<Collision> found;
    primitive_contacts(colliders_, BodyPair{BodyIndex(a), BodyIndex(b), query.activation}, query, found);
    return found;
  }

 private:
  std::deque<SharedShape> shapes_;
  std::deque<std::vector<Vec3>> vertices_;
  std::vector<Collider> colliders_;
};

inline Pose random_pose(Random& random, double spread) {
  Pose pose;
  pose.rotation = random.rotation();
  pose.position = spread * random.vector();
  return pose;
}

inline Pose then(const Pose& outer, const Pose& inner) {
  return {outer.rotation * inner.rotation, outer.apply(inner.position)};
}

inline double smallest_gap(const std::vector<Collision>& contacts) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Collision& c : contacts) gap = std::min(gap, c.gap);
  return gap;
}

}  // namespace impinge::test
