// Bodies that lie wholly inside others.
#pragma once

#include "engine/bodies/bodies.hpp"

namespace impinge {

struct Enclosure {
  BodyIndex inner, outer;
  double depth = 0.0;  ///< metres below the outer surface, of the inner one's point that is least deep
};

/// Of pairs that may touch and of which one moves by itself. Points of the inner one's surface decide, up to two thousand. A plane
/// encloses what is wholly below it.
std::vector<Enclosure> find_enclosures(const Bodies& bodies);

}  // namespace impinge
