// Surfaces of a frame as PLY files.
#pragma once

#include <filesystem>

#include "engine/world/step_record.hpp"

namespace impinge {

/// NAME.ply for each body but planes: meshes in source vertex order, sphere, box and capsule tessellated as drawn;
/// world coordinates at the end of the frame. Throws InputError where a file can't be written.
void export_surfaces(const std::filesystem::path& folder, const StepRecord& record);

}  // namespace impinge
