// Files that belong together, as a report and its pictures: all of them take their names at once, or none does, and what
// had those names stays.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace impinge {

class OutputFiles {
 public:
  OutputFiles() = default;
  /// Removes what was written and made, unless it was kept.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// A folder and those above it, as far as they are not there. Throws OutputError.
  void make_folder(const std::filesystem::path& folder);
  /// Under another name until it is kept. Throws OutputError.
  void write(const std::filesystem::path& file, std::string_view bytes);
  /// Throws OutputError.
  void keep();

 private:
  std::vector<std::filesystem::path> made_;                                       // in order
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> written_;  // as what, and to be called what
};

}  // namespace impinge
