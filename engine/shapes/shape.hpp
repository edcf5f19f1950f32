// What a body is made of for contact: an exact shape where one is meant, a triangle mesh otherwise.
// Exact shapes are given in the body's frame: a sphere, box or capsule is centred at its origin.
#pragma once

#include <memory>
#include <variant>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// The half-space n·x <= offset is solid, in the body's frame; static or scripted bodies only.
struct Plane {
  Vec3 normal = Vec3::UnitY();  ///< unit
  double offset = 0.0;          ///< metres
};
struct Sphere {
  double radius = 0.0;
};
struct Box {
  Vec3 half = Vec3::Zero();  ///< half of the full lengths
};
/// Axis y; the cap centres lie at y = +-half_length.
struct Capsule {
  double radius = 0.0;
  double half_length = 0.0;
};
/// A closed triangle surface in the body's frame, shared by all bodies made from the same file and scale.
struct SurfaceMesh {
  TriangleMesh mesh;
  MeshTopology topology;
};
using MeshPointer = std::shared_ptr<const SurfaceMesh>;

using Shape = std::variant<Plane, Sphere, Box, Capsule, MeshPointer>;

inline bool is_mesh(const Shape& shape) { return std::holds_alternative<MeshPointer>(shape); }

/// The word used for the shape in scene files and messages: plane, sphere, box, capsule, mesh.
const char* shape_name(const Shape& shape);

/// The twelve triangles of a box (exact: a box is a polyhedron), outward, with their topology.
MeshPointer make_box_mesh(const Vec3& half);

/// World bounds of a shape at a pose. A plane bounds its half-space where it is axis-aligned, else nothing. For meshes
/// pass the world vertices to bounds_of instead.
Aabb shape_bounds(const Shape& shape, const Pose& pose);

}  // namespace impinge
