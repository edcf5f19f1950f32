// The exact tests, one for each pair of shapes in the order plane, sphere, box, capsule, mesh. Each reads its two
// shapes from the sink and adds its contacts to it. Internal to the narrow phase: callers use primitive.hpp.
#pragma once

#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/geometry/oriented_box.hpp"

namespace impinge {

void plane_sphere(ContactSink& sink);
void plane_box(ContactSink& sink);
void plane_capsule(ContactSink& sink);
void plane_mesh(ContactSink& sink);
void sphere_sphere(ContactSink& sink);
void sphere_box(ContactSink& sink);
void sphere_capsule(ContactSink& sink);
void sphere_mesh(ContactSink& sink);
void box_box(ContactSink& sink);
void box_capsule(ContactSink& sink);
void box_mesh(ContactSink& sink);
void capsule_capsule(ContactSink& sink);
void capsule_mesh(ContactSink& sink);

// The shapes in world coordinates.
struct WorldPlane {
  Vec3 normal;
  double offset;
};
struct WorldSegment {
  Vec3 p0, p1;  ///< cap centres: 0 at -half_length, 1 at +half_length
};
inline WorldPlane world_plane(const Collider& c) {
  const Plane& plane = std::get<Plane>(*c.shape);
  const Vec3 normal = c.pose.rotation * plane.normal;
  return {normal, plane.offset + normal.dot(c.pose.position)};
}
inline OrientedBox world_box(const Collider& c) {
  return {c.pose.position, c.pose.rotation, std::get<Box>(*c.shape).half};
}
inline WorldSegment world_axis(const Collider& c) {
  const Vec3 reach = c.pose.rotation.col(1) * std::get<Capsule>(*c.shape).half_length;
  return {c.pose.position - reach, c.pose.position + reach};
}

}  // namespace impinge
