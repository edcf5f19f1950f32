// A run from its first frame to its last, into a run folder.
#pragma once

#include <functional>
#include <optional>

#include "engine/bodies/crushed.hpp"
#include "engine/io/folder_lock.hpp"
#include "viewer/controller/session.hpp"

namespace impinge {

struct RunOptions {
  std::filesystem::path scene, script;  ///< script may be empty
  std::filesystem::path out;
  std::optional<int> frames;               ///< the last frame's number
  std::optional<int> freeze;               ///< the frame whose last sub-step is written as a frozen step
  std::vector<std::string> overrides;      ///< PATH=VALUE
  std::uint64_t snapshot_megabytes = 256;  ///< room for the states of the frames
  int width = 1280, height = 720;          ///< pixels
  bool images = true, ids = false, contacts = false, export_ply = false, judge = false, resume = false;
  bool force = false;                ///< another run of ours in the folder gives way
  bool judge_substeps = false;       ///< at the end of each sub-step, not only of each frame
  std::vector<std::string> exports;  ///< formats (viewer/export) that the frames go to as well, into out/export
  /// false: `expect image` lines are left to the caller, and their files may be missing
  bool compares_pictures = true;
};

struct RunResult;

/// What the table says of a frame of an earlier process. Not a number where it has no such column.
struct EarlierFrame {
  int frame = 0;
  double unsafe_motions = 0.0;
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J
  bool is_driven = false;                                ///< as of RunWatcher::world
};

/// Whoever watches a run. Called in the thread of run().
struct RunWatcher {
  std::function<void(const FrameStats& stats, int last_frame)> frame;
  /// The same frame's world; `is_driven`: commands before it may have given energy.
  std::function<void(const World& world, bool is_driven)> world;
  /// Its picture is made, of this size in pixels.
  std::function<void(const StepRecord& record, const ViewSettings& settings, int width, int height)> picture;
  /// Of a run that goes on: frames that are there already.
  std::function<void(const EarlierFrame& earlier)> earlier_frame;
  /// What is known after a frame, in bytes that are kept with its state; and the same back, once earlier_frame was
  /// called for all of them.
  std::function<std::string()> save;
  std::function<void(std::string_view saved)> restore;
  std::function<void(const std::string& line)> message;  ///< a failed expectation, a break, a note
  /// Of what is said of a frame as it is made, and not again when the run goes on.
  std::function<void(const std::string& line)> note;
  /// All frames are made: what belongs to a whole run beside them, before the folder says that it is done.
  std::function<void(const RunResult& result)> whole;
};

struct RunResult {
  int last_frame = -1;    ///< whose row is in stats.csv
  int resumed_from = -1;  ///< the frame of the snapshot that was continued, -1: none
  int failures = 0;       ///< expectations not met
  bool stopped_by_break = false;
  bool is_judged = false;  ///< somebody looked for overlap, --judge or a run.toml that says so
  bool interrupted = false;
  std::filesystem::path frozen_step;  ///< written, "" if none
  std::size_t frozen_contacts = 0, frozen_groups = 0;
  double frames_per_second = 0;  ///< of simulated time
  /// Processor time of all steps, milliseconds; -1: not known, since there were several threads or an earlier process.
  double step_cpu_ms = 0.0;
  std::vector<CrushedBody> crushed;   ///< as the last frame left them
  std::string diverged;               ///< why, if the simulation left the finite numbers
  std::vector<std::string> exported;  ///< what there is to open, one a format
  FolderLock lock;                    ///< of the folder, for whoever adds to it what belongs to the run
  int exit_code() const;
};

/// Loads and checks everything before it writes anything. Throws InputError, and Interrupted while it loads; once
/// frames are made an interrupt (core/interrupt.hpp) ends the run after the last whole one.
RunResult run(const RunOptions& options, const RunWatcher& watcher);

}  // namespace impinge
