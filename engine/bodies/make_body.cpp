#include <fmt/format.h>

#include <Eigen/LU>

#include "engine/bodies/body_description.hpp"
#include "engine/bodies/fixed_body.hpp"
#include "engine/bodies/rigid_body.hpp"
#include "engine/bodies/scripted_body.hpp"
#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/geometry/surface/exempt_pairs.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

Pose file_pose_of(const BodyDescription& d) { return {rotation_from_degrees(d.rotation), d.position}; }

/// The part that all kinds have.
template <class Kind>
std::unique_ptr<Kind> identified(std::unique_ptr<Kind> body, const BodyDescription& d) {
  body->name = d.name;
  body->shape = d.shape;
  body->size = d.shape->size();
  body->surface_file = d.surface_file;
  body->friction = d.friction;
  body->restitution = d.restitution;
  body->self_collision = d.self_collision;
  body->self_exempt_distance = d.self_exempt_distance;
  if (d.self_collision && d.self_exempt_distance && d.shape->mesh() != nullptr)
    body->exempt_pairs = std::make_shared<const ExemptPairs>(*d.shape->mesh(), *d.self_exempt_distance);
  return body;
}

/// A copy of the mesh for a body of its own, and its vertices in the world, bytes.
double copy_bytes(const SurfaceMesh& surface) {
  const double triangles = static_cast<double>(surface.mesh.triangles.size()),
               vertices = static_cast<double>(surface.mesh.vertices.size());
  return 60.0 * triangles + 52.0 * vertices;
}

/// Frame and size of a body that moves as a whole. Returns the mass properties that its density gives it.
MassProperties recenter(const BodyDescription& d, Body& body) {
  if (d.shape->as<Plane>() != nullptr) return {};
  MassProperties properties = d.shape->mass(d.density);
  if (!(properties.mass > 0.0))
    throw InputError(
        "the surface encloses no positive volume; a body needs a closed surface whose triangles are "
        "counter-clockwise seen "
        "from outside; flip its triangles");
  body.center = properties.center;
  if (const SurfaceMesh* mesh = d.shape->mesh()) {
    body.mean_edge = mean_edge_length(mesh->mesh);
    check_memory("", "its surface", copy_bytes(*mesh), "simplify it, or use fewer bodies");
  }
  body.shape = d.shape->recentered(body.center);
  body.radius = body.shape->bounding_radius();
  return properties;
}

void place_at(const Pose& file, Body& body) {
  body.pose = {file.rotation, file.apply(body.center)};
  body.update_world_vertices();
}

std::unique_ptr<Body> make_fixed(const BodyDescription& d) {
  auto body = identified(std::make_unique<FixedBody>(), d);
  recenter(d, *body);
  place_at(file_pose_of(d), *body);
  return body;
}

std::unique_ptr<Body> make_scripted(const BodyDescription& d) {
  auto body = identified(std::make_unique<ScriptedBody>(), d);
  recenter(d, *body);
  if (!d.motion.empty()) body->motion = Motion(d.motion);
  place_at(d.motion.empty() ? file_pose_of(d) : body->motion.at(0.0), *body);
  return body;
}

std::unique_ptr<Body> make_rigid(const BodyDescription& d) {
  auto body = identified(std::make_unique<RigidBody>(), d);
  if (d.shape->as<Plane>() != nullptr)
    throw InputError("a dynamic body is a plane, which has no mass; a plane is static or scripted; use a box");
  const MassProperties properties = recenter(d, *body);
  const double ratio = d.mass ? *d.mass / properties.mass : 1.0;
  body->mass = properties.mass * ratio;
  body->set_inertia(properties.inertia * ratio);
  place_at(file_pose_of(d), *body);
  body->velocity = d.velocity;
  body->angular_momentum = body->world_inertia() * d.angular_velocity;
  return body;
}

/// Holds the nodes of the given regions; a node belongs to the first that holds it.
void hold_regions(std::span<const NodeRegion> regions, DeformableBody& body) {
  std::vector<int> all;
  std::vector<char> taken(static_cast<std::size_t>(body.nodes()), 0);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    HeldRegion region;
    for (int i = 0; i < body.nodes(); ++i) {
      const Vec3 x = body.position.segment<3>(3 * i);
      if (taken[i] || !regions[r].contains(i, x)) continue;
      taken[i] = 1;
      region.nodes.push_back(i);
      region.start.push_back(x);
      region.pivot += x;
    }
    if (region.nodes.empty())
      throw InputError(
          fmt::format("body '{}': region {} of fixed holds no node of the body; move or widen it", body.name, r));
    region.pivot /= static_cast<double>(region.nodes.size());
    if (!regions[r].motion.empty()) region.motion = Motion(regions[r].motion);
    all.insert(all.end(), region.nodes.begin(), region.nodes.end());
    body.held.push_back(std::move(region));
  }
  body.hold(all);
}

std::unique_ptr<Body> make_deformable(const BodyDescription& d) {
  const DeformableDescription& own = *d.deformable;
  std::shared_ptr<Material> material = make_named(materials(), own.model);
  material->settings() = own.material;
  configure(*material, own.settings);
  auto body = identified(std::make_unique<DeformableBody>(
                             FemAssembly(own.mesh, {{material, own.density}}, own.mass, {}, own.fraction, own.element)),
                         d);
  body->material = material;
  body->model = own.model;
  body->damping = own.damping;
  body->embedding = own.embedding;
  const Pose file = file_pose_of(d);
  body->placed = file;
  for (int i = 0; i < body->nodes(); ++i) body->position.segment<3>(3 * i) = file.apply(own.mesh.vertices[i]);
  const Vec3 center = body->center_of_mass();
  for (int i = 0; i < body->nodes(); ++i)
    body->velocity.segment<3>(3 * i) =
        d.velocity + d.angular_velocity.cross(Vec3(body->position.segment<3>(3 * i)) - center);
  hold_regions(own.fixed, *body);
  body->mean_edge = mean_edge_length(body->shape->mesh()->mesh);
  body->update_world_vertices();
  body->set_center_velocity(d.velocity);
  return body;
}

}  // namespace

std::unique_ptr<Body> make_body(const BodyDescription& d) {
  switch (d.kind) {
    case BodyKind::fixed:
      return make_fixed(d);
    case BodyKind::scripted:
      return make_scripted(d);
    case BodyKind::dynamic:
      return make_rigid(d);
    case BodyKind::deformable:
      return make_deformable(d);
  }
  throw InternalError("a body of no kind");
}

}  // namespace impinge
