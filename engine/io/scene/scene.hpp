// A scene file: parameters into their rows, bodies into the world. Also a finished run's run.toml, which is a scene
// with a table [run] beside it.
#pragma once

#include <map>
#include <optional>

#include "engine/io/scene/scene_surface.hpp"
#include "engine/world/world.hpp"

namespace impinge {

/// What run.toml records beside the scene: enough to repeat the run.
struct RunRecord {
  std::string version;  ///< of the program
  std::string scene;    ///< path of the scene file
  std::string folder;   ///< the folder its surfaces are relative to; in the file, where it isn't absolute, from there
  std::string script_file;          ///< path of the script, "" without one
  std::vector<std::string> script;  ///< its lines
  /// A state that it begins with, as snapshots/ has them, "" for the scene's own; in the file as `folder`.
  std::string start = {};
  int frames = 0;  ///< the last frame's number
  bool images = true, ids = false, contacts = false, export_ply = false, judge = false, judge_substeps = false;
  int width = 1280, height = 720;  ///< pixels
};

struct Scene {
  std::filesystem::path path;
  std::filesystem::path folder;  ///< surfaces are relative to it
  bool allow_outside_files = false;
  std::vector<TomlNode> bodies;       ///< as given, overrides applied
  std::vector<TomlNode> attachments;  ///< as given
  std::vector<SurfaceFile> surfaces;
  std::shared_ptr<SurfaceFiles> files;  ///< that have read them, for copies of its bodies
  std::vector<std::string> given;       ///< paths of the parameters that the file or an override names
  std::map<std::string, std::string, std::less<>> places;  ///< where each of them was given, for messages
  /// Former paths of parameters that the file or an override names, as often as they do.
  std::vector<std::string> former_paths;
  std::optional<RunRecord> run;  ///< of a run.toml
  bool has(std::string_view parameter) const;
};

/// Reads the scene into the world and the rows. Before: world.parameters.bind(rows) and whatever else has rows.
/// Overrides are `PATH=VALUE` texts and replace what the file says. After it, the bodies' rows `body.NAME.*` are
/// declared too. Throws InputError: one located message, the world then to be thrown away.
Scene load_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides, World& world,
                 ParameterSet& rows);

/// run.toml: the values that the rows have now, the bodies as given, and the run. load_scene reads it back.
std::string format_run(const Scene& scene, const ParameterSet& rows, const RunRecord& run);

}  // namespace impinge
