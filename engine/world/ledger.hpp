// Energy and momentum of all dynamic bodies: the quantities that contact must not make out of nothing.
#pragma once

#include <span>

#include "engine/bodies/rigid_body.hpp"

namespace impinge {

struct Ledger {
  double kinetic = 0.0;                  ///< J
  double elastic = 0.0;                  ///< J
  double potential = 0.0;                ///< -Σ m g·x, J
  Vec3 momentum = Vec3::Zero();          ///< kg·m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< about the world's origin, kg·m²/s
};

Ledger make_ledger(std::span<RigidBody> bodies, const Vec3& gravity);

}  // namespace impinge
