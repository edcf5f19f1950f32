// ParaView's list of files by time, .pvd.
#pragma once

#include <filesystem>
#include <string>

namespace impinge {

class PvdFile {
 public:
  PvdFile() = default;
  explicit PvdFile(const std::filesystem::path& path) : path_(path) {}

  /// `file` lies beside it; several of one time are parts of one picture.
  void add(double time, int part, const std::filesystem::path& file);
  bool is_empty() const { return entries_.empty(); }
  const std::filesystem::path& path() const { return path_; }
  /// Throws OutputError.
  void write() const;

 private:
  std::filesystem::path path_;
  std::string entries_;
};

}  // namespace impinge
