// Where a solid with a curved surface passes through triangles, by its formula: the triangles that stand for it in
// pictures are inside it, by more than a sheet is thick.
#pragma once

#include <optional>

#include "engine/detection/continuous/passages.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// The passages, A the body of convex solids and B the rigid mesh, of the earliest moment there is one, as first_passages
/// has them: places at which they are in a triangle by more than they may. Empty: none; nothing: it took too many looks, or
/// one of the two isn't rigid or not made of convex solids, so that their triangles have to be searched.
std::optional<std::vector<Passage>> first_solid_passages(const Shape& solid, const SurfacePath& own,
                                                         const SurfacePath& triangles, const PassageSettings& settings);

}  // namespace impinge
