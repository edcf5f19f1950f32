// The table [run] of a run.toml.
#pragma once

#include "engine/io/scene/scene.hpp"

namespace impinge {

RunRecord read_run_record(const TomlNode& table);
/// Refuses a surface file that has changed since the run.
void check_surface_hashes(const TomlNode& table, const std::vector<SurfaceFile>& surfaces);

}  // namespace impinge
