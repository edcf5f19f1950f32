// The factors of a Delassus operator of rigid bodies, W = J M⁻¹ Jᵀ: six velocities a body, whatever the contacts are.
#pragma once

#include <array>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

struct BodySpace {
  /// A body's columns in the rows of one contact; rows that the contact hasn't are 0.
  struct Side {
    int body = -1;  ///< none: a body that doesn't respond
    Mat3 linear = Mat3::Zero(), angular = Mat3::Zero();
  };
  std::vector<std::array<Side, 2>> sides;  ///< by contact
  std::vector<double> mass;                ///< by body, kg
  std::vector<Mat3> inertia;               ///< kg·m²
};

}  // namespace impinge
