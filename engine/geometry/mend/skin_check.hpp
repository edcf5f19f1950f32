// Whether a new skin (remesh.hpp) still is the solid that it was made round: walls thinner than a cell or two tear.
#pragma once

#include <string>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// What the skin has lost or won of a closed surface that faces outwards, and how many cells would do, in one sentence
/// without a full stop; "" where its parts and handles are the same and its volume is within a twentieth. Where the
/// surface crosses itself only the volume counts, of what it encloses: the skin may rightly be of another shape.
std::string skin_fault(const TriangleMesh& surface, const TriangleMesh& skin, int cells);

}  // namespace impinge
