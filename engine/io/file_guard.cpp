#include "engine/io/file_guard.hpp"

namespace impinge {

namespace fs = std::filesystem;

FileGuard::FileGuard(const fs::path& folder) {
  std::error_code error;
  folder_ = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
}

std::optional<fs::path> FileGuard::refused(const fs::path& file) const {
  if (!folder_) return std::nullopt;
  std::error_code error;
  // of a name that isn't there, a relative one would stay relative
  const fs::path place = fs::weakly_canonical(fs::absolute(file, error), error);
  const fs::path relative = place.lexically_relative(*folder_);
  const bool inside = !error && !relative.empty() && *relative.begin() != ".." && !relative.is_absolute();
  return inside ? std::nullopt : std::optional(error ? file : place);
}

}  // namespace impinge
