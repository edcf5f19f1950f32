// One job of a sweep: what it runs, what it is called, and its folder DIR/jobs/HASH.
//
//   job.toml    what it runs: enough to run it alone
//   lock        while somebody works on it: held by that process and by its child
//   run/        the run's own folder
//   output.txt  what the run said
//   done        how it ended, written last; a job that a crash ended has `failed` instead and is tried again
//   repeats/2 the second run of --repeat, with lock, run/, output.txt and done of its own, without pictures, surfaces
//   and contacts
#pragma once

#include <chrono>
#include <optional>

#include "engine/io/child_process.hpp"
#include "engine/io/folder_lock.hpp"
#include "viewer/controller/run.hpp"

namespace impinge {

struct SweepJob {
  RunOptions options;                ///< scene, script, --set and the rest, the same for all jobs but for `out`
  std::vector<std::string> changes;  ///< PATH=VALUE on top of options.overrides
  std::string hash;                  ///< of the resolved input, 16 hex digits
  std::string reference;             ///< hash of the job it is measured against, "" for none
};

/// Of the pictures' size and the judge, which every loading of a sweep's scene has in common.
SessionOptions sweep_session_options(const RunOptions& options);

/// A scene loaded once, to name the jobs that differ from it by a few values.
class SweepBase {
 public:
  /// Throws InputError as the run itself would.
  explicit SweepBase(const RunOptions& options);
  /// Of everything that decides the run: program version, scene, script, surface files, parameters with `changes`
  /// applied, frames, pictures. Where the files lie doesn't enter. A value that is no change gives the base's own hash.
  std::string hash(const std::vector<std::string>& changes) const;
  const Session& session() const { return session_; }
  int last_frame() const { return last_frame_; }

 private:
  RunOptions options_;
  Session session_;
  int last_frame_ = 0;
};

void write_sweep_job(const std::filesystem::path& folder, const SweepJob& job);
/// Throws InputError if the folder holds no job.
SweepJob read_sweep_job(const std::filesystem::path& folder);

/// How a job ended.
struct SweepOutcome {
  enum Status { done, failed, diverged, refused, crashed, interrupted, unequal, open };  // unequal: repeats differ
  Status status = open;
  std::string reason;    ///< one line, "" when done
  double wall_ms = 0.0;  ///< of the attempt that ended it
  /// Whether running it again could only say the same.
  bool is_final() const { return status == done || status == failed || status == diverged; }
};
const char* status_name(SweepOutcome::Status status);

SweepOutcome read_sweep_outcome(const std::filesystem::path& folder);

/// Whether all that a job's run was asked for is in its folder: impinge clean may have taken the pictures, or the
/// surfaces that errors are measured on. Such a job is run again from its beginning. Of a repeat only figures count.
bool has_what_was_asked(const std::filesystem::path& folder, const SweepJob& job);

std::filesystem::path job_folder(const std::filesystem::path& out, const std::string& hash);
/// Of the k-th run of a job, k >= 1; the first is the job's own folder.
std::filesystem::path repeat_folder(const std::filesystem::path& job, int k);

/// A job being run by a child process of this one.
class SweepWorker {
 public:
  enum Start { started, already_done, busy };
  /// Takes the job's lock and starts its run, which goes on where an earlier one stopped. `busy`: another process has
  /// it. `already_done`: also that nothing of what it made is gone.
  Start start(const std::filesystem::path& folder, const SweepJob& job);
  /// Whether it has ended; if so its outcome is written.
  bool poll();
  void interrupt() const;
  /// Returns when any child has ended and is not yet polled, a signal has come, or the time is up.
  static void wait_for_any(std::chrono::milliseconds most);
  SweepOutcome outcome() const { return outcome_; }

 private:
  std::filesystem::path folder_;
  FolderLock lock_;
  std::optional<ChildProcess> child_;  // after the lock, so that it is gone before that is given back
  std::chrono::steady_clock::time_point begin_;
  SweepOutcome outcome_;
};

}  // namespace impinge
