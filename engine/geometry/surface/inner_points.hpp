// Points well inside a closed surface: of two solids whose surfaces lie on one another these tell whether they are in the
// same place or touch, which no point of the surfaces does. Slow, and used by nobody but judges.
#pragma once

#include <vector>

#include "engine/geometry/edges_inside.hpp"

namespace impinge {

/// Of `most` triangles at most, spread over the list: half way from the middle of each to the other side of the solid.
std::vector<Vec3> inner_points(const PlacedMesh& mesh, std::size_t most);

}  // namespace impinge
