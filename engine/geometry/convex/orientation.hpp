// On which side of a plane a point lies, without rounding: what a convex hull may decide by.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// The sign of det(a - d, b - d, c - d): +1 if d lies behind the plane through a, b, c (seen from its front they run
/// counter-clockwise), -1 in front, 0 exactly in it. The determinant in doubles decides where its error bound allows,
/// else it is expanded exactly [Shewchuk97].
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// u × v with each component right to two units in the last place, also where u and v are nearly parallel (Kahan's
/// difference of products).
Vec3 accurate_cross(const Vec3& u, const Vec3& v);

}  // namespace impinge
