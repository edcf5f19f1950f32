// Which files in the folder of a run are the run's, and what each is for: by place and name. Whatever else lies there is
// somebody else's and is never touched; symbolic links are never followed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace impinge {

enum class RunPart : unsigned char {
  record,     ///< what repeats the run and what it measured: run.toml, tables, log, frozen steps
  pictures,   ///< frames, ids, contact sheet
  exports,    ///< surfaces of --export, and what impinge export writes into the folder
  snapshots,  ///< states, from which a run is resumed and opened in the debugger
  other       ///< nobody's of ours
};

struct RunFile {
  std::filesystem::path path;
  RunPart part = RunPart::other;
  std::uint64_t bytes = 0;
};

/// Whether impinge run has written this folder: its run.toml has a table [run].
bool is_run_folder(const std::filesystem::path& folder);
/// All files in it, sorted; a folder of a name that no part has is other, with all that is in it.
std::vector<RunFile> files_of_run(const std::filesystem::path& folder);
/// Folders of runs at or below a folder, sorted.
std::vector<std::filesystem::path> runs_below(const std::filesystem::path& folder);

/// Removes a file, and the folders that it leaves empty, up to the run's. Throws OutputError where that can't be done.
void remove_run_file(const std::filesystem::path& run, const std::filesystem::path& file);

/// Removes all of a run's own files but run.toml and the lock, which are what tells that the folder is a run's: `done`
/// first, so that at any moment what is left is a run that did not end.
void empty_run_folder(const std::filesystem::path& folder);

}  // namespace impinge
