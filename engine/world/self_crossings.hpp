// Where the surface of a deformable body crosses itself.
#pragma once

#include <cstdint>

#include "engine/bodies/bodies.hpp"

namespace impinge {

enum class CrossingsOf {
  all,             ///< deformable bodies
  self_colliding,  ///< those that look for contact with themselves: others have nothing to pay for
};

/// Pairs of triangles of one and the same deformable body that share a point and no vertex, of the body, or summed over all.
std::int64_t count_self_crossings(const Body& body, CrossingsOf which);
std::int64_t count_self_crossings(const Bodies& bodies, CrossingsOf which = CrossingsOf::all);

}  // namespace impinge
