// Boxes that move in a cube and bounce off its walls: the generator of the peers' broad-phase figures.
#pragma once

#include "engine/geometry/aabb.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

constexpr double kCoherent = 0.02, kFast = 0.5;  ///< metres a frame

/// n boxes with centres in [0, L]³, L = cbrt(n), half extents in [0.2, 0.55), velocities up to `speed` on each axis.
struct MovingBoxes {
  double length;
  std::vector<Vec3> center, half, velocity;
  std::vector<Aabb> boxes;

  MovingBoxes(int count, double speed) : length(std::cbrt(static_cast<double>(count))) {
    Random r(12345);
    for (int i = 0; i < count; ++i) {
      Vec3 c, h, v;
      for (int k = 0; k < 3; ++k) c[k] = length * r.u();
      for (int k = 0; k < 3; ++k) h[k] = 0.20 + 0.35 * r.u();
      for (int k = 0; k < 3; ++k) v[k] = speed * r.sym();
      center.push_back(c);
      half.push_back(h);
      velocity.push_back(v);
    }
    boxes.resize(center.size());
    place();
  }
  void step() {
    for (std::size_t i = 0; i < center.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        double& c = center[i][k];
        c += velocity[i][k];
        if (c < 0.0 || c > length) {
          c = c < 0.0 ? -c : 2.0 * length - c;
          velocity[i][k] = -velocity[i][k];
        }
      }
    place();
  }
  void place() {
    for (std::size_t i = 0; i < center.size(); ++i) boxes[i] = {center[i] - half[i], center[i] + half[i]};
  }
};

}  // namespace impinge::test
