#include "engine/bodies/rigid_body.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

/// A copy of the mesh for a body of its own, and its vertices in the world, bytes.
double copy_bytes(const SurfaceMesh& surface) {
  const double triangles = static_cast<double>(surface.mesh.triangles.size()),
               vertices = static_cast<double>(surface.mesh.vertices.size());
  return 60.0 * triangles + 52.0 * vertices;
}

}  // namespace

void RigidBody::set_inertia(const Mat3& about_center) {
  principal = principal_inertia(about_center);
  inertia = principal.matrix();
  inertia_inverse = principal.inverse();
}

void RigidBody::update_world_vertices() {
  const SurfaceMesh* mesh = shape->mesh();
  if (mesh == nullptr) return;
  if (soft) {
    interpolate(soft->embedding, soft->fem.fem.rest(), soft->fem.position, world_vertices);
    return;
  }
  const std::vector<Vec3>& local = mesh->mesh.vertices;
  world_vertices.resize(local.size());
  for (std::size_t i = 0; i < local.size(); ++i) world_vertices[i] = pose.apply(local[i]);
}

Aabb RigidBody::bounds() const {
  if (shape->mesh() == nullptr) return shape->bounds(pose);
  Aabb box;
  for (const Vec3& v : world_vertices) box.include(v);
  return box;
}

RigidBody make_rigid_body(const BodyDescription& description) {
  RigidBody body;
  body.name = description.name;
  body.kind = description.kind;
  body.shape = description.shape;
  body.surface_file = description.surface_file;
  body.friction = description.friction.value_or(-1.0);
  body.restitution = description.restitution.value_or(-1.0);
  body.self_collision = description.self_collision;

  if (body.is_deformable()) {
    const Pose file{rotation_from_degrees(description.rotation), description.position};
    try {
      body.soft = std::make_unique<SoftBody>(
          make_soft_body(*description.soft, file, description.velocity, description.angular_velocity));
    } catch (const InputError& error) {
      throw InputError(fmt::format("body '{}': {}", body.name, error.what()));
    }
    body.mass = body.soft->fem.fem.total_mass();
    body.velocity = description.velocity;
    body.mean_edge = mean_edge_length(body.shape->mesh()->mesh);
    body.update_world_vertices();
    body.soft->surface_velocity.assign(body.world_vertices.size(), description.velocity);
    return body;
  }
  const bool is_plane = body.shape->as<Plane>() != nullptr;
  if (is_plane && body.is_dynamic())
    throw InputError("a dynamic body is a plane, which has no mass; a plane is static or scripted; use a box");
  if (!is_plane) {
    MassProperties properties = body.shape->mass(description.density);
    if (!(properties.mass > 0.0))
      throw InputError(
          "the surface encloses no positive volume; a body needs a closed surface whose triangles are "
          "counter-clockwise seen "
          "from outside; flip its triangles");
    body.center = properties.center;
    if (const SurfaceMesh* mesh = description.shape->mesh()) {
      body.mean_edge = mean_edge_length(mesh->mesh);
      check_memory("", "its surface", copy_bytes(*mesh), "simplify it, or use fewer bodies");
    }
    body.shape = body.shape->recentered(body.center);
    if (body.is_dynamic()) {
      const double ratio = description.mass ? *description.mass / properties.mass : 1.0;
      body.mass = properties.mass * ratio;
      body.set_inertia(properties.inertia * ratio);
    }
    body.radius = body.shape->bounding_radius();
  }

  Pose file{rotation_from_degrees(description.rotation), description.position};
  if (body.kind == BodyKind::scripted && !description.motion.empty()) {
    body.motion = Motion(description.motion);
    file = body.motion.at(0.0);
  }
  body.pose = {file.rotation, file.apply(body.center)};
  if (body.is_dynamic()) {
    body.velocity = description.velocity;
    body.angular_momentum = body.world_inertia() * description.angular_velocity;
  }
  body.update_world_vertices();
  return body;
}

}  // namespace impinge
