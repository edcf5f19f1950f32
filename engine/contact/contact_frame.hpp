// The axes of a contact: its normal and two tangents that follow from it alone.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// t1 = normalised e x n with e the first world axis of smallest |n·e|; t2 = n x t1.
Vec3 tangent1(const Vec3& normal);

/// Rows n^T, t1^T, t2^T.
Mat3 contact_axes(const Vec3& normal);

}  // namespace impinge
