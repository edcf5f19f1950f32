// What impulses at a point of a rigid body make of its velocity there: the body's part of W_ii.
#pragma once

#include "engine/bodies/system_block.hpp"

namespace impinge {

/// Along the rows of `directions`, at `arm` from the centre of mass, 1/kg.
inline Mat3 mobility(const RigidBlock& block, const Mat3& directions, const Vec3& arm) {
  Mat3 turn;
  for (int k = 0; k < 3; ++k) turn.row(k) = arm.cross(directions.row(k).transpose()).transpose();
  return block.inverse_mass * directions * directions.transpose() + turn * block.inverse_inertia * turn.transpose();
}

}  // namespace impinge
