// The built program, run as a user runs it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace impinge::test {

struct Outcome {
  int code = -1;  ///< exit code; minus the signal's number if one ended it
  std::string out, err;
  int error_lines() const;
};

/// Runs a program in `folder` and waits for its end.
Outcome program_run(const std::filesystem::path& program, const std::filesystem::path& folder,
                    const std::vector<std::string>& arguments);
/// Runs impinge in `folder` and waits for its end.
Outcome impinge_run(const std::filesystem::path& folder, const std::vector<std::string>& arguments);

enum class Targets { program, children_first };

/// The same, but the program gets the signal after `seconds` unless it has ended; its children just before it if
/// wanted.
Outcome impinge_stopped(const std::filesystem::path& folder, const std::vector<std::string>& arguments, double seconds,
                        int signal, Targets targets = Targets::program);

}  // namespace impinge::test
