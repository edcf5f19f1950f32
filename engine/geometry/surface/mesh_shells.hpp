// The connected parts of a closed surface, and whether each faces the way it should.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// Triangles that are connected across edges. Parts that touch at vertices only are shells of their own.
struct Shell {
  std::vector<int> triangles;  ///< ascending
  double volume = 0.0;         ///< signed, m³; negative where the triangles face inwards
  Aabb box;
  int depth = 0;       ///< how many other shells contain it
  int container = -1;  ///< the innermost of those, −1 for none
};

/// The shells of a closed, consistently oriented mesh, by their first triangles, with what contains what.
///
/// A shell is contained in another one if its box is, none of its vertices lies outside of the other and some lie
/// inside (where all touch it, the triangles' midpoints are asked), and no vertex of the other lies inside of it.
/// Shells that pierce each other are so contained in neither, as far as their vertices show it; copies at the same
/// place contain nothing of each other.
std::vector<Shell> find_shells(const TriangleMesh& mesh, const MeshTopology& topology);

/// What is wrong with the orientation of the first shell that faces the wrong way, worded to follow the mesh's name:
/// a shell inside an even number of others (none: an outer wall) must face outwards, one inside an odd number (the
/// wall of a cavity) inwards. Shells too flat to have a side are left alone.
std::optional<std::string> check_shells(const TriangleMesh& mesh, const MeshTopology& topology);

}  // namespace impinge
