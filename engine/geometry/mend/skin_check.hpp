// Whether a new skin (remesh.hpp) still is the solid that it was made round: walls thinner than a cell or two tear.
#pragma once

#include <optional>
#include <string>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// In words without a full stop.
struct SkinFault {
  std::string what;    ///< the skin has lost or won
  std::string remedy;  ///< how many cells would do
};

/// Of the skin of a closed surface that faces outwards; none where its parts and handles are the same and its volume is
/// within a twentieth. Where the surface crosses itself only the volume counts, of what it encloses: the skin may rightly
/// be of another shape.
std::optional<SkinFault> skin_fault(const TriangleMesh& surface, const TriangleMesh& skin, int cells);

}  // namespace impinge
