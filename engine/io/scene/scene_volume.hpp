// The tetrahedra of a deformable [[body]] and the surface they carry: `volume` with `surface` or `shape`.
#pragma once

#include "engine/bodies/body_description.hpp"
#include "engine/io/scene/scene_surface.hpp"

namespace impinge {

/// Fills soft.mesh, .fraction and .embedding, body.shape and .surface_file; from a .veg file with a material also what
/// of young, poisson and density the scene doesn't give. Throws InputError, located, at the first key or value that
/// can't be taken.
void read_volume(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files,
                 DeformableDescription& soft, BodyDescription& body);

}  // namespace impinge
