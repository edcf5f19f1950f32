// Points well inside a closed surface: of two solids whose surfaces lie on one another these tell whether they are in the
// same place or touch, which no point of the surfaces does. For judges, and for what is looked at once.
#pragma once

#include <functional>
#include <vector>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/surface/searched_mesh.hpp"

namespace impinge {

/// Of `most` triangles at most, spread over the list: half way from the middle of each to the other side of the solid.
std::vector<Vec3> inner_points(const SearchedMesh& mesh, std::size_t most);
/// The deepest of them in another solid with that box, metres, not less than 0. `depth`: of a point in it.
double deepest_inner_point(const SearchedMesh& mesh, std::size_t most, const Aabb& box,
                           const std::function<double(const Vec3&)>& depth);

}  // namespace impinge
