// Time integration: how a body gets its free velocity v* and how a velocity moves its pose. [Haapaoja16 §2.1]
#pragma once

#include <span>

#include "engine/bodies/rigid_body.hpp"
#include "engine/core/registry.hpp"

namespace impinge {

class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Solves A v* = b without contacts, in place, for every dynamic body that is awake. gravity: m/s², time_step: s.
  virtual void free_velocity(std::span<RigidBody> bodies, const Vec3& gravity, double time_step) const = 0;
  /// q <- q (+) Δt G v for every dynamic body that is awake.
  virtual void advance(std::span<RigidBody> bodies, double time_step) const = 0;
};

const Registry<Integrator>& integrators();

}  // namespace impinge
