// What every scheme is for rigid bodies, where A = M and b = M v + Δt f: v* = v + Δt g, then the motion of rigid_motion.hpp.
#pragma once

#include "engine/integrators/integrator.hpp"
#include "engine/integrators/rigid_motion.hpp"

namespace impinge {

class RigidIntegrator : public Integrator {
 public:
  void free_velocity(std::span<RigidBody> bodies, const Vec3& gravity, double time_step) const override {
    for (RigidBody& body : bodies)
      if (body.is_dynamic() && !body.asleep) apply_gravity(body, gravity, time_step);
  }
  void advance(std::span<RigidBody> bodies, double time_step) const override {
    for (RigidBody& body : bodies)
      if (body.is_dynamic() && !body.asleep) advance_rigid(body, time_step);
  }
};

}  // namespace impinge
