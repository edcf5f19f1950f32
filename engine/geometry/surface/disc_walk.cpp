#include "engine/geometry/surface/disc_walk.hpp"

#include <cmath>

namespace impinge {

DiscWalk::DiscWalk(const DiscTree& a, const DiscTree& b, bool is_self, const Pose& b_in_a, double margin)
    : a_(a), b_(b), is_self_(is_self) {
  const Vec3 position = b_in_a.apply(b.origin()) - a.origin();
  for (int i = 0; i < 3; ++i) {
    position_[i] = static_cast<float>(position[i]);
    for (int j = 0; j < 3; ++j) {
      rotation_[i][j] = static_cast<float>(b_in_a.rotation(i, j));
      turned_[i][j] = std::abs(rotation_[i][j]) * (1.0f + 1e-6f);
    }
  }
  const double rounding = 1e-6 * (b.reach() + position.cwiseAbs().maxCoeff());
  margin_ = static_cast<float>((margin + rounding) * (1.0 + 1e-6));
}

}  // namespace impinge
