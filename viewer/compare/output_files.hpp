// Files that belong together, as a report and its pictures: all of them are written, or none is left.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace impinge {

class OutputFiles {
 public:
  OutputFiles() = default;
  /// Removes what was written and made, unless it was kept. What a file of the same name held before is lost.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// A folder and those above it, as far as they are not there. Throws OutputError.
  void make_folder(const std::filesystem::path& folder);
  /// Throws OutputError.
  void write(const std::filesystem::path& file, std::string_view bytes);
  void keep() { made_.clear(); }

 private:
  std::vector<std::filesystem::path> made_;  // in order
};

}  // namespace impinge
