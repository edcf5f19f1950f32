// How a body is coloured, the same in every layer and frame.
#pragma once

#include "viewer/layers/layer.hpp"

namespace impinge {

/// Dynamic bodies take turns through the palette in scene order; static grey, scripted pale.
/// `given`: entries of view.colors, which come first.
std::vector<Color> body_colors(const StepRecord& record, const std::vector<std::string>& given);

/// Whether the scene has such bodies (or nodes, vertices, tetrahedra of some body): what a legend need not explain
/// else.
bool has_rigid(const StepRecord& record);
bool has_deformable(const StepRecord& record);
bool has_held_nodes(const StepRecord& record);
bool has_outside_vertices(const StepRecord& record);
bool has_everted(const StepRecord& record);
bool has_attachments(const StepRecord& record);

/// Whether contact moves it: dynamic and deformable bodies.
bool is_moved_by_contact(const BodyRecord& body);

/// Where nothing is thinned all of `count`, else about `most` of them, evenly spaced.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

/// A static box that is thin like a wall and stands between the eye and what it looks at.
bool is_wall_in_the_way(const BodyRecord& body, const Camera& camera);

/// A static box that is thin like a wall.
bool is_wall(const BodyRecord& body);

}  // namespace impinge
