// A bundle: a moment of a debugger's session in one file that says all of it elsewhere. It is the folder of a run, with
// every mesh that the scene reads beside its run.toml, as a tar whose first part names the others:
//
//   impinge-bundle/bundle.toml        versions, the moment, size and hash of each part
//   impinge-bundle/run.toml           the scene as it was resolved, with the script and what was set by hand
//   impinge-bundle/meshes/            files that the scene reads
//   impinge-bundle/stats.csv          figures and state hash of every frame up to the moment
//   impinge-bundle/snapshots/         states of the moment's frame and of the one before
//   impinge-bundle/frozen/            the frame's last sub-step, for impinge step; of frame 0 none
//   impinge-bundle/recording.script   what was done, as it was recorded
//   impinge-bundle/opening.script     lines that show the same again: view, panels, breakpoints, selection
//   impinge-bundle/picture.png        what was seen
//
// `tar xf` makes that folder of it, which `impinge debug` and `impinge replay` take too.
#pragma once

#include <filesystem>
#include <map>

#include "engine/io/tar.hpp"

namespace impinge {

struct BundleHead {
  std::string version = IMPINGE_VERSION;  ///< of the program
  std::string scene;                      ///< the file's name
  int frame = 0;
  int stage = -1;  ///< place within the making of the frame (engine/world/stage_place.hpp); -1: at its end
  std::uint64_t state_hash = 0;  ///< at the end of the frame
};

/// `parts` by their names in the folder. Throws InputError where one doesn't fit.
std::string format_bundle(const BundleHead& head, const std::map<std::string, std::string>& parts);

struct Bundle {
  BundleHead head;
  std::map<std::string, std::string_view> parts;  ///< by name in the folder, bundle.toml left out
};
/// `bytes` must outlive the answer. Throws InputError `file: found; allowed; remedy` unless it is whole: every part there,
/// none besides, each of its size and hash.
Bundle parse_bundle(const std::string& file, std::string_view bytes);

/// Whether the file begins as a bundle does. False where it can't be read.
bool is_bundle(const std::filesystem::path& path);

/// A bundle as a folder, for as long as this lives.
class UnpackedBundle {
 public:
  /// Checks all of it before it writes anything. Throws InputError for a file that is no whole bundle, OutputError where
  /// there is no room.
  explicit UnpackedBundle(const std::filesystem::path& file);
  ~UnpackedBundle();
  UnpackedBundle(const UnpackedBundle&) = delete;
  UnpackedBundle& operator=(const UnpackedBundle&) = delete;

  const BundleHead& head() const { return head_; }
  const std::filesystem::path& folder() const { return folder_; }
  /// Lines of a script among the parts; none where there is no such part.
  std::vector<std::string> lines(const std::string& part) const;

 private:
  BundleHead head_;
  std::filesystem::path folder_;
};

}  // namespace impinge
