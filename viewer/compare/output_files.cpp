#include "viewer/compare/output_files.hpp"

#include <fmt/format.h>

#include "engine/io/file.hpp"

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
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path path = fs::absolute(folder).lexically_normal(); !path.empty() && !fs::exists(path, error);
       path = path.parent_path())
    missing.push_back(path);
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw OutputError(
        fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out",
                    folder.string(), error ? error.message() : "a file of that name exists"));
  made_.insert(made_.end(), missing.rbegin(), missing.rend());
}

void OutputFiles::write(const fs::path& file, std::string_view bytes) {
  write_file(file, bytes);
  made_.push_back(file);
}

}  // namespace impinge
