// Bodies that lie wholly inside others, or in the same place.
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

/// Of bodies whose surfaces lie on one another: the deepest in the other of points well inside either mesh, metres. 0 where
/// they only touch, or none is a mesh.
double depth_in_one_place(const Body& a, const Body& b);

}  // namespace impinge
