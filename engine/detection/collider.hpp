// What collision detection sees of a body at one instant: geometry in world coordinates and velocities, nothing else.
#pragma once

#include <span>

#include "engine/geometry/aabb.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

class ExemptPairs;

struct Collider {
  const Shape* shape = nullptr;
  const SurfaceMesh* surface = nullptr;  ///< the triangles it is looked at as, if they are not a mesh's own
  Pose pose;                             ///< of the body's frame; exact shapes are placed by it
  /// World positions of a mesh's vertices (empty for exact shapes): of a rigid one, the pose applied to the mesh's own.
  std::span<const Vec3> vertices;
  Aabb bounds;                              ///< world bounds, not inflated
  Vec3 velocity = Vec3::Zero();             ///< of the frame's origin, m/s: the free velocity v* of this sub-step
  Vec3 angular_velocity = Vec3::Zero();     ///< rad/s
  std::span<const Vec3> vertex_velocities;  ///< of a deformable body's surface; empty for a rigid one
  /// Of a deforming mesh that several shapes are near: the boxes of its tree where they are now, by node; else empty.
  std::span<const Aabb> node_boxes;
  bool self_collision = false;
  const ExemptPairs* exempt_pairs = nullptr;  ///< of its own triangles; null: none
  double mean_edge = 0.0;                     ///< mean edge length of a mesh, metres
  double size = 0.0;                          ///< of the body at rest, metres; infinite of a plane

  const SurfaceMesh& mesh() const { return surface != nullptr ? *surface : *shape->mesh(); }
  /// Velocity of the material point of a rigid body that is at `point` (world).
  Vec3 velocity_at(const Vec3& point) const { return velocity + angular_velocity.cross(point - pose.position); }
  /// Velocity of mesh vertex i.
  Vec3 vertex_velocity(int i) const {
    return vertex_velocities.empty() ? velocity_at(vertices[i]) : vertex_velocities[i];
  }
};

}  // namespace impinge
