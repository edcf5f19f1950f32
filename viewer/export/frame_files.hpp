// Files that come one a frame, NAME.000000.ply: programs number them by themselves.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace impinge {

class FrameFiles {
 public:
  FrameFiles() = default;
  FrameFiles(const std::filesystem::path& folder, std::string ending) : folder_(folder), ending_(std::move(ending)) {}

  /// Where the stem's file of a frame belongs.
  std::filesystem::path of_frame(const std::string& stem, int frame);
  /// Where the one that holds for all frames does.
  std::filesystem::path of_all(const std::string& stem) const { return folder_ / (stem + ending_); }
  /// What an earlier export left of the same sequences, at other frames.
  void remove_others() const;

 private:
  std::filesystem::path folder_;
  std::string ending_;  // with its dot
  std::set<std::string> stems_, names_;
};

}  // namespace impinge
