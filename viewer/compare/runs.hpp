// Where two recorded runs part, and how far.
#pragma once

#include <filesystem>

namespace impinge {

struct RunsOptions {
  std::filesystem::path a, b;  ///< folders of runs
  std::filesystem::path out;   ///< for difference.csv, its plot and frames side by side; "" for none
  int tolerance = 3;           ///< of pictures: of a channel, of 255
};

/// Prints what was set differently, and in which frame, body and field they part. Returns the exit code: 1 where they
/// do. Throws InputError.
int compare_runs(const RunsOptions& options);

}  // namespace impinge
