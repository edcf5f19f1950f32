// The tests of pairs of shapes. Each reads its two shapes from the sink and adds its contacts to it. Internal to the
// narrow phase: callers use primitive.hpp.
#pragma once

#include "engine/core/error.hpp"
#include "engine/detection/pairs/contact_sink.hpp"
#include "engine/geometry/oriented_box.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {

/// A test of two shapes by their names; the sink's first shape is the first of them, whichever body stands earlier in
/// the scene.
struct PairTest {
  std::string_view first, second;
  void (*test)(ContactSink&);
};

/// Pairs with a test of their own (all.cpp).
const std::vector<PairTest>& pair_tests();

void plane_sphere(ContactSink& sink);
void plane_box(ContactSink& sink);
void plane_capsule(ContactSink& sink);
void sphere_sphere(ContactSink& sink);
void sphere_box(ContactSink& sink);
void sphere_capsule(ContactSink& sink);
void sphere_mesh(ContactSink& sink);
void box_box(ContactSink& sink);
void box_capsule(ContactSink& sink);
void box_mesh(ContactSink& sink);
void capsule_capsule(ContactSink& sink);
void capsule_mesh(ContactSink& sink);

// By form, for all others.
void plane_convex(ContactSink& sink);
void plane_mesh(ContactSink& sink);
void convex_convex(ContactSink& sink);
void convex_mesh(ContactSink& sink);
/// convex_mesh of a polyhedron: the sink's first shape has one.
void hull_mesh(ContactSink& sink);

/// The shape of a collider that is known to be a T.
template <class T>
const T& shape_of(const Collider& c) {
  const T* shape = c.shape->as<T>();
  IMPINGE_ASSERT(shape != nullptr);
  return *shape;
}

// The shapes in world coordinates.
struct WorldPlane {
  Vec3 normal;
  double offset;
};
struct WorldSegment {
  Vec3 p0, p1;  ///< cap centres: 0 at -half_length, 1 at +half_length
};
inline WorldPlane world_plane(const Collider& c) {
  const Plane& plane = shape_of<Plane>(c);
  const Vec3 normal = c.pose.rotation * plane.normal;
  return {normal, plane.offset + normal.dot(c.pose.position)};
}
inline OrientedBox world_box(const Collider& c) { return {c.pose.position, c.pose.rotation, shape_of<Box>(c).half}; }
inline WorldSegment world_axis(const Collider& c) {
  const Vec3 reach = c.pose.rotation.col(1) * shape_of<Capsule>(c).half_length;
  return {c.pose.position - reach, c.pose.position + reach};
}

}  // namespace impinge
