// Rigid bodies on their way, as poses at even moments.
#pragma once

#include "engine/geometry/rotation.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// Straight on by up to `way`, metres, and evenly round an axis by up to `turn`, rad; pieces + 1 poses.
inline std::vector<Pose> path(Random& random, const Pose& start, double way, double turn, int pieces) {
  const Vec3 shift = way * random.vector(), axis = turn * random.vector();
  std::vector<Pose> poses;
  for (int i = 0; i <= pieces; ++i) {
    const double t = static_cast<double>(i) / pieces;
    poses.push_back({rotation_exp(t * axis) * start.rotation, start.position + t * shift});
  }
  return poses;
}

}  // namespace impinge::test
