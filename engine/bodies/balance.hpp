// Energy and momentum: the quantities that contact must not make out of nothing.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

struct Balance {
  double kinetic = 0.0;                  ///< J
  double elastic = 0.0;                  ///< J
  double potential = 0.0;                ///< -Σ m g·x, J
  Vec3 momentum = Vec3::Zero();          ///< kg·m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< about the world's origin, kg·m²/s

  Balance& operator+=(const Balance& more) {
    kinetic += more.kinetic, elastic += more.elastic, potential += more.potential;
    momentum += more.momentum, angular_momentum += more.angular_momentum;
    return *this;
  }
};

}  // namespace impinge
