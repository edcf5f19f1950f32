#include "viewer/compare/output_files.hpp"

#include <fmt/format.h>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

namespace fs = std::filesystem;

OutputFiles::~OutputFiles() {
  std::error_code error;
  while (!made_.empty()) {
    fs::remove(made_.back(), error);  // of folders only those that are empty
    made_.pop_back();
  }
}

void OutputFiles::make_folder(const fs::path& folder) {
  std::vector<fs::path> missing;
  for (fs::path path = absolute_path(folder).lexically_normal(); !path.empty() && !is_there(path);
       path = path.parent_path())
    missing.push_back(path);
  impinge::make_folder(folder);
  made_.insert(made_.end(), missing.rbegin(), missing.rend());
}

void OutputFiles::write(const fs::path& file, std::string_view bytes) {
  write_file(file, bytes);
  made_.push_back(file);
}

}  // namespace impinge
