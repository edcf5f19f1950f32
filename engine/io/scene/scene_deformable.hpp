// What a deformable [[body]] has beside a rigid one: material.model and its numbers, volume, fixed.
#pragma once

#include "engine/bodies/body_description.hpp"
#include "engine/io/scene/scene_surface.hpp"

namespace impinge {

/// Fills body.deformable and body.shape. The keys that all bodies share have been read; `scale` is the body's. Throws
/// InputError, located, at the first key or value that can't be taken.
void read_deformable_body(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files,
                          BodyDescription& body);

/// The keys of such a body's `material`: density, which all bodies have, and what only deformable ones can use.
std::vector<std::string> deformable_material_keys();

}  // namespace impinge
