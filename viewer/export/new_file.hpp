// A file that grows under a temporary name and gets its own when it is whole; else nothing of it is left.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "engine/io/append_file.hpp"

namespace impinge {

class NewFile {
 public:
  /// Throws OutputError where it can't be made.
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Throws OutputError where the disk is full.
  void append(std::string_view text);
  /// What was appended so far, piece by piece.
  void read_back(const std::function<void(std::string_view)>& piece);
  /// Gives it its name.
  void keep();
  const std::filesystem::path& path() const { return path_; }

 private:
  void flush();

  std::filesystem::path path_, temporary_;
  AppendFile file_;
  std::string waiting_;
  bool kept_ = false;
};

}  // namespace impinge
