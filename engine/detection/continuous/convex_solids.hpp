// Rigid bodies as convex solids on their way.
#pragma once

#include <vector>

#include "engine/geometry/convex/minkowski.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// The convex solids of a shape, in its frame; none of what isn't made of them.
std::vector<PlacedConvex> convex_solids(const Shape& shape);

/// A solid whose body has this pose.
PlacedConvex placed(const PlacedConvex& solid, const Pose& pose);

/// The point of the solid that is farthest along a unit direction.
Vec3 farthest(const PlacedConvex& solid, const Vec3& direction);

/// As the frame `of` sees it.
Pose seen_from(const Pose& of, const Pose& pose);

}  // namespace impinge
