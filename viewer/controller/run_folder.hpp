// The folder of a run: what is in it, when it may be written to, and where an interrupted run goes on.
//
// A folder may be new or empty, or hold a run with the same run.toml, which is then made again in place. Any other
// folder is refused. With `resume` a run that differs at most in a larger number of frames is continued; with `force` any
// other run of ours gives way. Foreign files stay.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>

#include "engine/io/append_file.hpp"
#include "engine/io/folder_lock.hpp"
#include "viewer/controller/command.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

/// What to do with a folder that holds a run already.
enum class RunStart { anew, resume, force };

class RunFolder {
 public:
  /// Throws InputError, with nothing written, if the folder can't be taken, because another process writes into it for
  /// one, or resumed since another version wrote its states; otherwise it holds run.toml and the files that grow, cut
  /// back to the last frame from which the run can go on.
  RunFolder(const std::filesystem::path& folder, const RunRecord& run, const std::string& run_toml, RunStart how,
            std::uint64_t snapshot_bytes, const StatsShape& shape);

  /// Rows of the frames that are kept, 0 to resume_frame(); empty for a new run.
  const std::vector<StatsLine>& kept() const { return kept_; }
  int resume_frame() const { return static_cast<int>(kept_.size()) - 1; }
  std::filesystem::path snapshot(int frame) const;
  std::filesystem::path picture(int frame) const;
  std::filesystem::path id_picture(int frame) const;
  std::filesystem::path frozen_step(int frame) const;
  const std::filesystem::path& path() const { return folder_; }

  /// Everything of a frame but its picture; the row of stats.csv comes last. `stats`: the record's, with what was
  /// measured since; `own`: the values of the scene's own columns.
  void add_frame(const StepRecord& record, std::span<const Command> commands, const FrameStats& stats,
                 std::span<const double> own);
  /// Of every frame, until they fill their room: then every second one is given up, and so on. The last one always
  /// stays. `notes`: what whoever watches the run knows so far.
  void add_snapshot(const Session& session, std::string_view notes);
  void add_frozen_step(const FrozenStep& step);
  /// Says that all of it is there. `step_cpu_ms`: what the steps took of the processor; negative: not known.
  void finish(double step_cpu_ms);
  /// The folder's, which ends with this object otherwise.
  FolderLock hand_over_lock() { return std::move(lock_); }

 private:
  void check_new(RunStart how, const std::string& run_toml) const;
  int last_resumable(const std::vector<StatsLine>& rows) const;
  void clear_markers();
  /// What a process that was killed in the middle of a file has left.
  void clear_leftovers() const;
  void forget_snapshot(int frame);

  std::filesystem::path folder_;
  RunRecord run_;
  FolderLock lock_;
  std::vector<StatsLine> kept_;
  std::uint64_t most_snapshot_bytes_, snapshot_bytes_ = 0;  // room for them, and taken
  std::map<int, std::uint64_t> snapshots_;                  // bytes by frame
  int spacing_ = 1;                                         // frames from one that stays to the next
  StatsColumns columns_;  // of stats.csv: a run that goes on keeps those it began with
  AppendFile stats_, contacts_, commands_;
  std::optional<AppendFile> ledger_;  // from the first frame on that has one
};

/// What finish() was told; none where it wasn't known, or the run isn't finished.
std::optional<double> recorded_step_cpu_ms(const std::filesystem::path& folder);

}  // namespace impinge
