// Where the surface of a deformable body crosses itself.
#pragma once

#include <cstdint>

#include "engine/bodies/bodies.hpp"

namespace impinge {

/// Pairs of triangles of one and the same deformable body that share a point and no vertex, summed over the bodies,
/// whether they look for contact with themselves or not.
std::int64_t count_self_crossings(const Bodies& bodies);

}  // namespace impinge
