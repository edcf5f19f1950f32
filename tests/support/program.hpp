// The built program, run as a user runs it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace impinge::test {

struct Outcome {
  int code = -1;  ///< exit code; minus the signal's number if one ended it
  std::string out, err;
  int error_lines() const;
};

/// Runs impinge in `folder` and waits for its end.
Outcome impinge_run(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

enum class Targets { program, children_first };

/// The same, but the program gets the signal after `seconds` unless it has ended; its children just before it if
/// wanted.
Outcome impinge_stopped(const std::filesystem::path& folder, const std::vector<std::string>& arguments, double seconds,
                        int signal, Targets targets = Targets::program);

/// The same, watched: `look` is called about every millisecond, with its process.
Outcome impinge_watched(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                        const std::function<void(pid_t)>& look);

}  // namespace impinge::test
