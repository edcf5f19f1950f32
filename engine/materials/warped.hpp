// Linear elasticity in a turned frame: what linear and corotational materials share.
#pragma once

#include "engine/materials/material.hpp"

namespace impinge {

/// Stiffness blocks R K_ab Rᵀ of linear elasticity, K_ab = V (λ g_a g_bᵀ + μ g_b g_aᵀ + μ (g_a·g_b) I).
inline void warped_stiffness(const TetRest& rest, const Mat3& rotation, const Lame& lame, ElementResponse& out) {
  const Corners g = rotation * rest.gradient;
  for (int block = 0; block < 10; ++block) {
    const Vec3 a = g.col(kBlockRow[block]), b = g.col(kBlockColumn[block]);
    const Vec3 la = rest.volume * lame.lambda * a, ma = rest.volume * lame.mu * a;
    Mat3& k = out.stiffness[block];
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) k(i, j) = la[i] * b[j] + b[i] * ma[j];
    k.diagonal().array() += ma.dot(b);
  }
}

}  // namespace impinge
