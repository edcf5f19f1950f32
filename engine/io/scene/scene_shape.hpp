// `shape = { word = { keys } }` of a scene as a shape, by the keys that the shape itself lists.
#pragma once

#include "engine/io/scene/scene_surface.hpp"

namespace impinge {

/// The one shape that the table names, its lengths times `scale`. Throws InputError, located, at the first key or value
/// that can't be taken.
SharedShape read_shape(const TomlNode& node, const std::string& what, double scale, SurfaceFiles& files);

}  // namespace impinge
