// The table [run] of a run.toml.
#pragma once

#include "engine/io/scene/scene.hpp"

namespace impinge {

RunRecord read_run_record(const TomlNode& table);
/// Refuses a surface file that has changed since the run.
void check_surface_hashes(const TomlNode& table, const std::vector<SurfaceFile>& surfaces);

/// A setting that two runs don't share.
struct SettingDifference {
  std::string path, a, b;  ///< values as TOML; "" where there is none
};
/// Of two documents, by paths; bodies and attachments by their names, lines of the script by what they say.
std::vector<SettingDifference> setting_differences(const TomlNode& run_a, const TomlNode& run_b);

}  // namespace impinge
