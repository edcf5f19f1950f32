// Two points, of two bodies or of a body and the world, that stay together.
#pragma once

#include <string>

#include "engine/core/types.hpp"

namespace impinge {

struct AttachmentDescription {
  std::string name;
  std::string body_a, body_b;  ///< body_b empty: the world
  Vec3 point = Vec3::Zero();   ///< of both, world coordinates at the start, metres
};

}  // namespace impinge
