// A file that grows by whole pieces: what is appended is handed to the system before the call returns.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace impinge {

class AppendFile {
 public:
  AppendFile() = default;
  /// Opens or makes the file and cuts it to `keep` bytes. Throws InputError.
  AppendFile(const std::filesystem::path& path, std::uint64_t keep);
  ~AppendFile();
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;

  /// Throws InputError where the disk is full; the file then ends as it did before.
  void append(std::string_view text);

 private:
  std::string name_;
  int handle_ = -1;
};

}  // namespace impinge
