#include "engine/bodies/body.hpp"

#include "engine/bodies/time_integration.hpp"
#include "engine/core/archive.hpp"

namespace impinge {

constexpr std::uint8_t kAsleep = 1, kPulled = 2, kDeleted = 4, kLags = 8;  // in a saved state

Aabb Body::bounds() const { return shape->mesh() == nullptr ? shape->bounds(pose) : vertex_bounds_; }

void Body::find_vertex_bounds() {
  vertex_bounds_ = {};
  for (const Vec3& v : world_vertices) vertex_bounds_.include(v);
}

void Body::update_world_vertices() {
  const SurfaceMesh* mesh = shape->mesh();
  if (mesh == nullptr) return;
  const std::vector<Vec3>& local = mesh->mesh.vertices;
  // what stands still is asked in every sub-step, however many vertices it has
  if (world_vertices.size() == local.size() && pose.rotation == placed_.rotation && pose.position == placed_.position)
    return;
  world_vertices.resize(local.size());
  for (std::size_t i = 0; i < local.size(); ++i) world_vertices[i] = pose.apply(local[i]);
  placed_ = pose;
  find_vertex_bounds();
}

SystemBlock Body::system_block() const { throw InternalError("body '" + name + "' has no freedom and no equations"); }

CarriedPoint Body::carry(const MaterialPoint&, const Vec3& at) const {
  CarriedPoint carried;
  carried.arm = at - pose.position;
  carried.velocity_before = before_.linear + before_.angular.cross(carried.arm);
  const Twist now = twist();
  carried.prescribed.push_back({1.0, now.linear + now.angular.cross(carried.arm)});
  return carried;
}

MaterialPoint Body::surface_point(TriangleIndex, const Vec3& world) const {
  MaterialPoint point;
  point.local = pose.apply_inverse(world);
  return point;
}

Vec3 Body::material_normal(const MaterialPoint&, const Vec3& world) const { return pose.rotation.transpose() * world; }

Vec3 Body::world_normal(const MaterialPoint&, const Vec3& material) const {
  return (pose.rotation * material).normalized();
}

MaterialPoint Body::point_beside(const MaterialPoint&, const Vec3& world) const { return surface_point({}, world); }

MaterialPoint Body::inner_point(const Vec3& world) const { return surface_point({}, world); }

Vec3 Body::mean_gravity(const TimeIntegration& how) const {
  if (lag == 0.0 || lag_gravity == how.gravity) return how.gravity;
  return how.gravity + lag / kick * (lag_gravity - how.gravity);
}

void Body::save_frame(ByteWriter& out, const Vec3& velocity, const Vec3& angular_momentum,
                      const Vec3& angular_velocity) const {
  out.put(pose.position), out.put(pose.rotation);
  out.put(velocity), out.put(angular_momentum), out.put(angular_velocity);
  out.put<std::uint8_t>((asleep ? kAsleep : 0) | (pull ? kPulled : 0) | (deleted ? kDeleted : 0) |
                        (lag != 0.0 ? kLags : 0));
  out.put(rest_time), out.put(island.value());
  if (pull) pull->save(out);
  if (lag != 0.0) out.put(lag), out.put(lag_gravity);
}

Body::Frame Body::restore_frame(ByteReader& in) {
  pose.position = in.get_vec3(), pose.rotation = in.get_mat3();
  Frame frame;
  frame.velocity = in.get_vec3(), frame.angular_momentum = in.get_vec3(), frame.angular_velocity = in.get_vec3();
  const auto marks = in.get<std::uint8_t>();
  asleep = (marks & kAsleep) != 0, deleted = (marks & kDeleted) != 0;
  rest_time = in.get<double>(), island = BodyIndex(in.get<int>());
  pull.reset();
  if ((marks & kPulled) != 0) pull = Pull::restore(in);
  lag = (marks & kLags) != 0 ? in.get<double>() : 0.0;
  lag_gravity = lag != 0.0 ? in.get_vec3() : Vec3(Vec3::Zero());
  return frame;
}

}  // namespace impinge
