// One [[body]] of a scene as a checked description.
#pragma once

#include "engine/bodies/rigid_body.hpp"
#include "engine/io/scene/scene_surface.hpp"

namespace impinge {

/// Throws InputError, located, at the first key or value that can't be taken.
BodyDescription read_body(const TomlNode& table, SurfaceFiles& surfaces);

/// Whether it may name a body: [A-Za-z_][A-Za-z0-9_-]*
bool is_body_name(std::string_view name);

}  // namespace impinge
