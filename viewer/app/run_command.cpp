// impinge run
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/core/error.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/app/convergence_note.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/app/interrupt.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/present/video.hpp"

namespace impinge {

namespace {

/// Before anything is simulated: a film that could not be written at the end.
void check_video_path(const std::filesystem::path& video, const std::filesystem::path& out) {
  const std::filesystem::path folder = absolute_path(video).lexically_normal().parent_path();
  static const std::vector<std::string> kEndings = {".mp4", ".mkv", ".mov", ".avi"};
  if (std::find(kEndings.begin(), kEndings.end(), video.extension().string()) == kEndings.end())
    throw InputError(fmt::format("command line: --video is '{}'; its name ends in one of {}; change it", video.string(),
                                 fmt::join(kEndings, ", ")));
  // the run's own folder comes into being with the run
  const bool is_own = folder == (absolute_path(out) / "").lexically_normal().parent_path();
  if (!is_own && !is_folder(folder))
    throw InputError(fmt::format("command line: --video is '{}'; there is no folder {}; make it or name another",
                                 video.string(), folder.string()));
  if (!is_own && access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(
        fmt::format("command line: --video is '{}'; it can't be written ({}); a folder that may be written to is "
                    "wanted; name another",
                    video.string(), std::strerror(errno)));
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
  explain_interrupt("stopping at the last whole frame, within 2 s");
  FrameProgress progress;
  RunWatcher watcher;
  if (!arguments.video.empty()) check_video_path(arguments.video, options.out);
  const bool shows_progress = !arguments.quiet && isatty(STDERR_FILENO);
  ConvergenceNote convergence;
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
    fmt::print(stderr, "interrupted {} {}; the same command with --resume goes on\n",
               result.last_frame < 0 ? "before frame" : "after frame", std::max(0, result.last_frame));
  const std::string sheet =
      options.images && result.exit_code() < 2 ? write_contact_sheet(options.out, result.last_frame) : "";
  const bool filmed = !sheet.empty() && !arguments.video.empty() && write_video(arguments, result.frames_per_second);
  if (arguments.quiet) return result.exit_code();

  fmt::print("{}", convergence.text());
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
