#include "viewer/compare/output_files.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_output(const fs::path& file, const std::string& reason) {
  throw OutputError(fmt::format("{}: can't be written ({}); free space or choose another --out", file.string(), reason),
                    reason);
}

}  // namespace

OutputFiles::~OutputFiles() {
  std::error_code error;
  for (const auto& [temporary, name] : written_) fs::remove(temporary, error);
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
  const fs::path temporary = temporary_name(file);
  try {
    if (is_folder(file)) throw OutputError(file.string(), std::strerror(EISDIR));
    write_file(temporary, bytes);
  } catch (const OutputError& error) {
    refuse_output(file, error.reason);
  }
  written_.emplace_back(temporary, file);
}

void OutputFiles::keep() {
  for (const auto& [temporary, name] : written_)
    if (std::rename(temporary.c_str(), name.c_str()) != 0) refuse_output(name, std::strerror(errno));
  written_.clear();
  made_.clear();
}

}  // namespace impinge
