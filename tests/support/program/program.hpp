// The built program, run as a user runs it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

struct Outcome {
  int code = -1;  ///< exit code; minus the signal's number if one ended it
  std::string out, err;
  int error_lines() const;
};

/// What a program finds when it starts, beside its words.
struct Surroundings {
  bool without_rights = false;     ///< root may not pass over permissions; see can_lose_rights()
  bool in_removed_folder = false;  ///< the folder it is started in (which must be empty) is gone
  std::filesystem::path out = {};  ///< where its stdout goes, "": into Outcome::out
};

/// Whether a program without_rights meets permissions here: as any user but root, or as root who may give rights up.
bool can_lose_rights();

/// impinge, or another program, at work; killed at the end if it still is.
class RunningProgram {
 public:
  RunningProgram(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                 const Surroundings& surroundings = {}, const std::filesystem::path& program = IMPINGE_PROGRAM);
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  bool has_ended();
  /// What it has said on stderr by now.
  std::string err() const { return slurp(streams_ / "err"); }
  Outcome wait();

 private:
  TempFolder streams_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

/// Runs a program in `folder` and waits for its end.
Outcome program_run(const std::filesystem::path& program, const std::filesystem::path& folder,
                    const std::vector<std::string>& arguments);
/// Runs impinge in `folder` and waits for its end.
Outcome impinge_run(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                    const Surroundings& surroundings = {});

enum class Targets { program, children_first };

/// The same, but the program gets the signal after `seconds` unless it has ended; its children just before it if
/// wanted.
Outcome impinge_stopped(const std::filesystem::path& folder, const std::vector<std::string>& arguments, double seconds,
                        int signal, Targets targets = Targets::program);

/// The same, watched: `look` is called about every millisecond, with its process.
Outcome impinge_watched(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
                        const std::function<void(pid_t)>& look);

}  // namespace impinge::test
