// Two pictures, or two folders of pictures name by name.
#pragma once

#include <filesystem>

namespace impinge {

struct PicturesOptions {
  std::filesystem::path a, b;  ///< PNG files or folders: what is wanted, and what there is
  std::filesystem::path out;   ///< for report.html and the pictures in it; "" for none
  std::filesystem::path mask;  ///< PNG, "" for none
  int tolerance = 3;           ///< of a channel, of 255
  bool update = false;         ///< make A what B is where they differ
};

/// Prints what differs and in what. Returns the exit code: 1 where something does, or could not be updated. Throws
/// InputError.
int compare_pictures(const PicturesOptions& options);

}  // namespace impinge
