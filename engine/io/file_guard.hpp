// Where the files that a scene names, and those that such a file names, may lie.
#pragma once

#include <filesystem>
#include <optional>

namespace impinge {

class FileGuard {
 public:
  /// Everything is allowed.
  FileGuard() = default;
  /// What really lies in the folder or below it is: symbolic links of either are followed first. "" is the present
  /// folder.
  explicit FileGuard(const std::filesystem::path& folder);

  /// Where the file, there or not, really lies, if that is not allowed; nothing if it is.
  std::optional<std::filesystem::path> refused(const std::filesystem::path& file) const;

 private:
  std::optional<std::filesystem::path> folder_;  // canonical
};

/// Most files that one file may have opened: what includes others must not grow without bound.
inline constexpr int kMostIncludes = 64;

}  // namespace impinge
