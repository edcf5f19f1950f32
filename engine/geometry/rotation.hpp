// Rotations: angles to matrix and back, exponential and logarithm.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// Rotation by degrees about the fixed axes x, then y, then z.
Mat3 rotation_from_degrees(const Vec3& degrees);
/// The inverse; of the two solutions the one with |y| <= 90°.
Vec3 degrees_from_rotation(const Mat3& rotation);

/// exp([w]x): the rotation by |w| radians about w.
Mat3 rotation_exp(const Vec3& w);
/// A pose after a shift and a turn by the rotation vector `turn` about its own origin.
Pose moved(const Pose& pose, const Vec3& shift, const Vec3& turn);
/// The w of smallest length with exp([w]x) = R, |w| <= pi.
Vec3 rotation_log(const Mat3& rotation);
/// The nearest rotation to a matrix that rounding has taken a little off (via a unit quaternion).
Mat3 orthonormalized(const Mat3& rotation);

}  // namespace impinge
