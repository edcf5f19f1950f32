// Small scenes for tests, built without files.
#pragma once

#include <algorithm>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/rigid_body.hpp"
#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/world/world.hpp"

namespace impinge::test {

inline constexpr double kGravity = 9.81;  ///< m/s², the default scene's

/// The body of that place in the scene, as what it is there.
template <class Kind, class W>
auto& body_as(W& world, int i) {
  auto* body = world.bodies()[i].template as<Kind>();
  if (body == nullptr) throw InternalError("a body of another kind");
  return *body;
}
inline RigidBody& rigid(World& world, int i) { return body_as<RigidBody>(world, i); }
inline const RigidBody& rigid(const World& world, int i) { return body_as<RigidBody>(world, i); }
inline DeformableBody& deformable(World& world, int i) { return body_as<DeformableBody>(world, i); }
inline const DeformableBody& deformable(const World& world, int i) { return body_as<DeformableBody>(world, i); }

/// The greatest speed of a point of what moves freely, m/s.
inline double fastest(const World& world) {
  double speed = 0.0;
  for (const Body& b : world.bodies())
    if (b.kind() == BodyKind::dynamic) speed = std::max(speed, b.fastest_point());
  return speed;
}

inline BodyDescription fixed_plane(const char* name, const Vec3& normal, double offset) {
  BodyDescription d;
  d.name = name;
  d.kind = BodyKind::fixed;
  d.shape = Plane{normal.normalized(), offset};
  return d;
}

inline BodyDescription dynamic_body(const std::string& name, const SharedShape& shape, const Vec3& position) {
  BodyDescription d;
  d.name = name;
  d.shape = shape;
  d.position = position;
  return d;
}

inline BodyDescription fixed_body(const std::string& name, const SharedShape& shape,
                                  const Vec3& position = Vec3::Zero()) {
  BodyDescription d = dynamic_body(name, shape, position);
  d.kind = BodyKind::fixed;
  return d;
}

inline BodyDescription cube(const std::string& name, double size, const Vec3& position) {
  return dynamic_body(name, Box{Vec3::Constant(0.5 * size)}, position);
}

inline void run(World& world, int frames) {
  for (int i = 0; i < frames; ++i) world.step();
}

/// Height of a body's frame over the plane y = 0 and how far its y axis is from upright, degrees.
inline double tilt_degrees(const Body& body) {
  double best = 180.0;
  for (int k = 0; k < 3; ++k) {
    const double c = std::abs(body.pose.rotation.col(k).y());
    best = std::min(best, std::atan2(std::sqrt(std::max(0.0, 1.0 - c * c)), c) * 180.0 / M_PI);
  }
  return best;
}

}  // namespace impinge::test
