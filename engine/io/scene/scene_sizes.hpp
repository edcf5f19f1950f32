// What a body may measure and weigh: beyond that squares and cubes of it leave the range of doubles somewhere, and a
// number is a slip, not a quantity.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/io/scene/toml.hpp"

namespace impinge {

/// The length at `node` times the body's scale, metres. Throws InputError, located there, unless it is in [1e-6, 1e6].
double scene_size(const TomlNode& node, const std::string& what, double scale);

/// The mass at `node`, kg. Throws InputError, located there, unless it is in [1e-15, 1e15].
double scene_mass(const TomlNode& node, const std::string& what);

/// Throws InputError, located at the node that names their file, unless all sides of the box round the vertices, which
/// have been scaled, are in [1e-6, 1e6] metres.
void check_extent(const TomlNode& node, const std::string& what, const std::vector<Vec3>& vertices, double scale);

/// Throws InputError, located at the density where the table of the body has one, unless what the body weighs is in
/// [1e-15, 1e15] kg.
void check_mass(const TomlNode& table, const Body& body);

}  // namespace impinge
