// Two solids on their way, told apart by a plane: in short pieces of the path one face of either stands between them as a
// rule, and then no feature needs to be searched for the moment at which it meets another.
#pragma once

#include "engine/detection/continuous/surface_path.hpp"

namespace impinge {

/// Whether two rigid surfaces of few vertices are known to overlap nowhere by more than `depth`, metres, all along their
/// paths. False where it isn't known: then they have to be searched.
bool stays_beside(const SurfacePath& a, const SurfacePath& b, double depth);

}  // namespace impinge
