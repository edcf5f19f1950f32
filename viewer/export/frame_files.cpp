#include "viewer/export/frame_files.hpp"

#include <fmt/format.h>

#include "engine/io/paths.hpp"

namespace impinge {

namespace fs = std::filesystem;

fs::path FrameFiles::of_frame(const std::string& stem, int frame) {
  stems_.insert(stem);
  return folder_ / *names_.insert(fmt::format("{}.{:06}{}", stem, frame, ending_)).first;
}

void FrameFiles::remove_others() const {
  for (const std::string& name : names_in(folder_)) {
    if (names_.contains(name) || !name.ends_with(ending_)) continue;
    const std::string numbered = name.substr(0, name.size() - ending_.size());
    const std::size_t dot = numbered.rfind('.');
    if (dot == std::string::npos || numbered.size() - dot < 7 ||
        numbered.find_first_not_of("0123456789", dot + 1) != std::string::npos ||
        !stems_.contains(numbered.substr(0, dot)))
      continue;
    std::error_code error;
    fs::remove(folder_ / name, error);
  }
}

}  // namespace impinge
