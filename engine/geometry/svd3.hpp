// Singular values and rotations of a 3 × 3 deformation gradient, for elements of any shape: stretched, flat, inverted,
// a point.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// F = U diag(sigma) Vᵀ with det U = det V = 1, so that U and V are rotations and an inversion shows as sigma[2] < 0.
/// sigma[0] >= sigma[1] >= |sigma[2]|, to rounding.
struct Svd3 {
  Mat3 u;
  Vec3 sigma;
  Mat3 v;
};

/// Never fails: F = 0 gives rotations too. Relative error near rounding, small singular values included. A NaN in F
/// ends in NaN, not in a loop.
Svd3 rotation_svd(const Mat3& f);

/// The rotation nearest to F (F = R S), det R = 1 also where F is inverted or flat: U Vᵀ of rotation_svd.
Mat3 nearest_rotation(const Mat3& f);

}  // namespace impinge
