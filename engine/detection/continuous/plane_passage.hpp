// Rigid bodies that end behind a plane. What is through a plane is inside it still, and contacts push it out; but they hold
// the points that were lowest where the sub-step began, and what turns on its way comes down with others.
#pragma once

#include <optional>

#include "engine/detection/continuous/passages.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {

/// The passage of a rigid body (A) through a plane (B), if the one ends deeper in the other than settings allow, and deeper
/// than it began: of the point that is lowest when it has come through. Of a mesh the hull counts.
std::optional<Passage> passage_through_plane(const Shape& shape, const SurfacePath& of_shape, const Plane& plane,
                                             const SurfacePath& of_plane, const PassageSettings& settings);

}  // namespace impinge
