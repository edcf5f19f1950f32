#include "engine/io/paths.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/io/file.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const std::error_code& error) {
  const char* remedy = "check the path and the disk";
  if (error == std::errc::permission_denied) remedy = "check its permissions and those of the folders above it";
  if (error == std::errc::too_many_symbolic_link_levels) remedy = "mend its symbolic links";
  if (error == std::errc::filename_too_long) remedy = "name a shorter one";
  throw InputError(fmt::format("{}: can't be read ({}); {}", path.string(), error.message(), remedy));
}

}  // namespace

PathKind path_kind(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  switch (status.type()) {
    case fs::file_type::not_found:
      return PathKind::nothing;
    case fs::file_type::regular:
      return PathKind::file;
    case fs::file_type::directory:
      return PathKind::folder;
    case fs::file_type::none:
      refuse(path, error);
    default:
      return PathKind::other;
  }
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) refuse(folder, error);
  std::sort(names.begin(), names.end());
  return names;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return;
  const std::string reason = error ? error.message() : "a file of that name exists";
  throw OutputError(
      fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out",
                  folder.string(), reason),
      reason);
}

fs::path absolute_path(const fs::path& path) {
  std::error_code error;
  fs::path whole = path.empty() ? fs::current_path(error) : fs::absolute(path, error);
  if (error)
    throw InputError(
        fmt::format("{}: the folder that the program was started in can't be told ({}); start it in another",
                    path.empty() ? "." : path.string(), error.message()));
  return whole;
}

}  // namespace impinge
