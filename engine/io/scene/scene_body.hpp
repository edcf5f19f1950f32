// One [[body]] of a scene as a checked description.
#pragma once

#include "engine/bodies/body_description.hpp"
#include "engine/io/scene/scene_surface.hpp"

namespace impinge {

/// Throws InputError, located, at the first key or value that can't be taken.
BodyDescription read_body(const TomlNode& table, SurfaceFiles& surfaces);

/// Most letters of a name: it is part of the names of files.
inline constexpr std::size_t kMostNameLetters = 128;

/// What is wrong with it as a name, what is allowed and the remedy; "": nothing. `whose`: "a body".
std::string fault_of_name(std::string_view name, const char* whose);

/// Refuses what may not name a body or an attachment: [A-Za-z_][A-Za-z0-9_-]*, of kMostNameLetters at most.
void check_name(const TomlNode& node, const std::string& name, const char* whose);

}  // namespace impinge
