// How a body is coloured, the same in every layer and frame.
#pragma once

#include "viewer/layers/layer.hpp"

namespace impinge {

/// Dynamic bodies take turns through the palette in scene order; static grey, scripted pale.
std::vector<Color> body_colors(const StepRecord& record);

/// A static box that is thin like a wall and stands between the eye and what it looks at.
bool is_wall_in_the_way(const BodyRecord& body, const Camera& camera);

/// A static box that is thin like a wall.
bool is_wall(const BodyRecord& body);

}  // namespace impinge
