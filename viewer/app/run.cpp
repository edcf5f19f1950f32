// impinge run
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "engine/core/error.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/present/video.hpp"

namespace impinge {

namespace {

/// What a run must not keep to its table: solves that ended at the iteration cap.
struct Convergence {
  std::int64_t solves = 0;
  int frames = 0, worst_frame = 0;
  double worst = 0.0;  // m/s
  void add(const FrameStats& stats) {
    solves += stats.unconverged;
    frames += stats.unconverged > 0;
    if (stats.unconverged > 0 && stats.residual > worst) worst = stats.residual, worst_frame = stats.frame;
  }
  void report() const {
    if (solves == 0) return;
    fmt::print(
        "note:     {} group solve{} in {} frame{} stopped at lcp.max_iterations; the largest residual was {:.2g} m/s "
        "in frame {}\n",
        solves, solves == 1 ? "" : "s", frames, frames == 1 ? "" : "s", worst, worst_frame);
  }
};

/// Before anything is simulated: a film that could not be written at the end.
void check_video_path(const std::filesystem::path& video, const std::filesystem::path& out) {
  const std::filesystem::path folder = std::filesystem::absolute(video).lexically_normal().parent_path();
  static const std::vector<std::string> kEndings = {".mp4", ".mkv", ".mov", ".avi"};
  if (std::find(kEndings.begin(), kEndings.end(), video.extension().string()) == kEndings.end())
    throw InputError(fmt::format("command line: --video is '{}'; its name ends in one of {}; change it", video.string(),
                                 fmt::join(kEndings, ", ")));
  // the run's own folder comes into being with the run
  const bool is_own = folder == (std::filesystem::absolute(out) / "").lexically_normal().parent_path();
  if (!is_own && !std::filesystem::is_directory(folder))
    throw InputError(fmt::format("command line: --video is '{}'; there is no folder {}; make it or name another",
                                 video.string(), folder.string()));
}

// the path of the sheet
std::string write_contact_sheet(const std::filesystem::path& out, int last_frame) {
  std::vector<std::filesystem::path> frames;
  for (int frame = 0; frame <= last_frame; ++frame) frames.push_back(out / "frames" / PngSequence::file_name(frame));
  const std::filesystem::path sheet = out / "contact_sheet.png";
  write_png(sheet, make_contact_sheet(frames, 5, 25));
  return sheet.string();
}

bool write_video(const Arguments& arguments, double frames_per_second) {
  const bool made = make_video(arguments.run_options.out / "frames", arguments.video, frames_per_second);
  if (!made) fmt::print(stderr, "note: ffmpeg is not installed, so there is no video\n");
  return made;
}

}  // namespace

int run_command(const Arguments& arguments) {
  const RunOptions& options = arguments.run_options;
  watch_for_interrupt();
  FrameProgress progress;
  RunWatcher watcher;
  watcher.interrupted = &interrupted();
  if (!arguments.video.empty()) check_video_path(arguments.video, options.out);
  const bool shows_progress = !arguments.quiet && isatty(STDERR_FILENO);
  Convergence convergence;
  watcher.frame = [&](const FrameStats& stats, int last_frame) {
    convergence.add(stats);
    if (shows_progress) progress.show(stats.frame, last_frame, fmt::format("  contacts {}", stats.contacts));
  };
  watcher.message = [&](const std::string& line) {
    progress.clear();
    fmt::print(stderr, "{}\n", line);
  };
  const RunResult result = run(options, watcher);
  progress.clear();
  if (!result.diverged.empty()) fmt::print(stderr, "diverged: {}\n", result.diverged);
  if (result.interrupted)
    fmt::print(stderr, "interrupted after frame {}; the same command with --resume goes on\n", result.last_frame);
  const std::string sheet =
      options.images && result.exit_code() < 2 ? write_contact_sheet(options.out, result.last_frame) : "";
  const bool filmed = !sheet.empty() && !arguments.video.empty() && write_video(arguments, result.frames_per_second);
  if (arguments.quiet) return result.exit_code();

  convergence.report();
  if (result.resumed_from >= 0) fmt::print("resumed:  after frame {}\n", result.resumed_from);
  if (options.images && result.last_frame >= 0)
    fmt::print("pictures: {}/frames/000000.png ... {:06}.png\n", options.out.string(), result.last_frame);
  fmt::print("figures:  {}/stats.csv ({} frames)\n", options.out.string(), result.last_frame + 1);
  if (!result.frozen_step.empty())
    fmt::print("frozen:   {} ({} group{}, {} contact{}); impinge step solves it\n", result.frozen_step.string(),
               result.frozen_groups, result.frozen_groups == 1 ? "" : "s", result.frozen_contacts,
               result.frozen_contacts == 1 ? "" : "s");
  if (!sheet.empty()) fmt::print("at once:  {}\n", sheet);
  if (filmed) fmt::print("video:    {}\n", arguments.video);
  if (result.failures > 0) fmt::print("failed:   {} expectation{}\n", result.failures, result.failures == 1 ? "" : "s");
  return result.exit_code();
}

}  // namespace impinge
