// impinge run
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/controller/run.hpp"
#include "viewer/export/exports.hpp"
#include "viewer/image/contact_sheet.hpp"
#include "viewer/image/png.hpp"
#include "viewer/notes/crushed_note.hpp"
#include "viewer/notes/run_notes.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/present/video.hpp"

namespace impinge {

namespace {

/// Before anything is simulated: a film that could not be written at the end.
void check_video_path(const std::filesystem::path& video) {
  const std::filesystem::path folder = absolute_path(video).lexically_normal().parent_path();
  const std::vector<std::string>& endings = video_endings();
  if (std::find(endings.begin(), endings.end(), video.extension().string()) == endings.end())
    throw InputError(fmt::format("command line: --video is '{}'; its name ends in one of {}; change it", video.string(),
                                 fmt::join(endings, ", ")));
  // a folder comes into being with the film, as that of --out does with the run
  std::filesystem::path above = folder;
  while (!is_there(above) && above.has_relative_path()) above = above.parent_path();
  if (!is_folder(above))
    throw InputError(
        fmt::format("command line: --video is '{}'; {} is no folder; name another", video.string(), above.string()));
  if (access(above.c_str(), W_OK | X_OK) != 0)
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

bool write_video(const std::filesystem::path& out, const std::filesystem::path& video, double frames_per_second) {
  make_folder(absolute_path(video).parent_path());
  const bool made = make_video(out / "frames", video, frames_per_second);
  if (!made) fmt::print(stderr, "note: ffmpeg is no longer there, so there is no video\n");
  return made;
}

void take_earlier(RunNotes& notes, const EarlierFrame& earlier) {
  notes.watchdog.add_earlier(earlier.frame, earlier.unsafe_motions);
  notes.balance.add_earlier({earlier.frame, earlier.kinetic, earlier.elastic, earlier.potential}, earlier.is_driven);
}

/// The first of FOLDER, FOLDER-2, FOLDER-3, ... that nobody has: made, so that no other process takes it, and removed
/// again if nothing was written into it.
class NumberedFolder {
 public:
  explicit NumberedFolder(const std::filesystem::path& wanted) {
    const std::filesystem::path whole = wanted.has_filename() ? wanted : wanted.parent_path();
    if (whole.has_parent_path()) make_folder(whole.parent_path());
    for (int number = 1;; ++number) {
      path_ = number == 1 ? whole : std::filesystem::path(fmt::format("{}-{}", whole.string(), number));
      if (mkdir(path_.c_str(), 0777) == 0) return;
      if (errno != EEXIST)
        throw OutputError(
            fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out",
                        path_.string(), std::strerror(errno)));
    }
  }
  ~NumberedFolder() { rmdir(path_.c_str()); }  // does nothing unless it is empty
  NumberedFolder(const NumberedFolder&) = delete;
  NumberedFolder& operator=(const NumberedFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class RunCommand : public SubCommand {
 public:
  void declare(Options& options) override;
  int run() override;

 private:
  void take_formats(const std::string& formats);

  RunOptions options_;
  std::filesystem::path video_;
  bool quiet_ = false, strict_ = false, number_ = false;
};

/// ply is what it was before there were others.
void RunCommand::take_formats(const std::string& formats) {
  for (std::size_t begin = 0; begin <= formats.size();) {
    const std::size_t end = std::min(formats.find(',', begin), formats.size());
    const std::string format = formats.substr(begin, end - begin);
    begin = end + 1;
    if (format == "ply") {
      options_.export_ply = true;
    } else {
      const std::string name = format == "sequence" ? "ply" : format;
      find_exporter(name, "--export");
      if (std::find(options_.exports.begin(), options_.exports.end(), name) == options_.exports.end())
        options_.exports.push_back(name);
    }
  }
}

void RunCommand::declare(Options& options) {
  scene_options(options, options_.scene, options_.overrides);
  script_option(options, options_.script);
  options.path("--out", options_.out, "folder to write to (default: out/SCENE)");
  frames_option(options, options_.frames);
  size_option(options, options_.width, options_.height);
  images_option(options, options_.images);
  options.other(
      "--export", [this](const std::string& formats) { take_formats(formats); },
      "one or several, with commas between them. ply: the bodies' surfaces in a folder a frame, surfaces/NNNNNN; into "
      "export/, as impinge export writes them: sequence (its ply), obj, gltf, vtu, usda, poses.csv, poses.json");
  options.flag("--contacts", options_.contacts, "write contacts.csv");
  options.flag("--ids", options_.ids,
               "write ids/NNNNNN.png too: what each pixel of a frame shows, for impinge diff to name what changed");
  options.whole(
      "--snapshots", [this](int megabytes) { options_.snapshot_megabytes = static_cast<std::uint64_t>(megabytes); }, 0,
      1 << 20,
      "megabytes for the states of the frames (default: 256): from these a run is resumed, and opened in the debugger "
      "without being simulated again; where they don't fit every second one is given up, and so on");
  judge_option(options, options_);
  options.flag(
      "--strict", strict_,
      "exit code 1 if a body may have passed another, or overlaps one by more than half a thickness by its own "
      "contacts, or where --judge looks by more than 10 %, by vertices or edges");
  options.whole("--freeze", options_.freeze, 0, 100'000'000,
                "a frame whose last sub-step is written to frozen/NNNNNN.step before its response, for impinge step");
  threads_option(options);
  options.flag("--resume", options_.resume, "continue an interrupted run in the folder");
  options.flag("--force", options_.force, "replace another run in the folder; files that no run wrote stay");
  options.flag("--number", number_,
               "if the folder is there already, write to the first of FOLDER-2, FOLDER-3, ... that is not");
  options.path("--video", video_, "film to make of the pictures, by ffmpeg: NAME.mp4, or .gif, .webp for a message");
  quiet_option(options, quiet_);
}

int RunCommand::run() {
  if (options_.out.empty()) options_.out = default_out(options_.scene);
  if (options_.resume + options_.force + number_ > 1)
    refuse_option(fmt::format("{} and {}", options_.resume ? "--resume" : "--force", number_ ? "--number" : "--force"),
                  "a folder that is there is continued, replaced or left alone", "leave out one of them");
  if (!video_.empty() && !options_.images)
    refuse_option("--video in a run without pictures", "pictures are wanted", "leave out --no-images");
  explain_interrupt("stopping at the last whole frame, within 2 s");
  FrameProgress progress;
  RunWatcher watcher;
  if (!video_.empty()) check_video_path(video_);
  const bool films = !video_.empty() && has_ffmpeg();
  if (films != !video_.empty())
    fmt::print(
        stderr,
        "note: ffmpeg is not installed: the pictures are made, and no {}; once it is there the same command with "
        "--resume makes it of them\n",
        video_.string());
  const bool shows_progress = !quiet_ && isatty(STDERR_FILENO);
  RunNotes notes;
  watcher.frame = [&](const FrameStats& stats, int last_frame) {
    notes.add(stats);
    if (shows_progress) progress.show(stats.frame, last_frame, fmt::format("  contacts {}", stats.contacts));
  };
  watcher.world = [&](const World& world, bool is_driven) { notes.add(world, is_driven); };
  watcher.picture = [&](const auto&... picture) { notes.empty.add(picture...); };
  watcher.earlier_frame = [&](const EarlierFrame& earlier) { take_earlier(notes, earlier); };
  watcher.save = [&] { return notes.saved(); };
  watcher.message = [&](const std::string& line) {
    progress.clear();
    fmt::print(stderr, "{}\n", line);
  };
  watcher.note = [&](const std::string& line) {
    notes.told.push_back(line);
    watcher.message(line);
  };
  watcher.restore = [&](std::string_view saved) {
    notes.restore(saved);
    for (const std::string& line : notes.told) watcher.message(line);
  };
  std::string sheet;
  if (options_.images)
    watcher.whole = [&](const RunResult& result) { sheet = write_contact_sheet(options_.out, result.last_frame); };
  std::optional<NumberedFolder> numbered;
  if (number_) options_.out = numbered.emplace(options_.out).path();
  const RunResult result = impinge::run(options_, watcher);
  progress.clear();
  if (!result.diverged.empty()) fmt::print(stderr, "diverged: {}\n", result.diverged);
  if (result.interrupted)
    fmt::print(stderr, "interrupted {} {}; the same command with --resume goes on\n",
               result.last_frame < 0 ? "before frame" : "after frame", std::max(0, result.last_frame));
  const bool filmed = !sheet.empty() && films && write_video(options_.out, video_, result.frames_per_second);
  notes.watchdog.set_judged(result.is_judged);
  const bool is_too_bad = strict_ && notes.watchdog.has_barked();
  const int code = result.exit_code() == 0 && is_too_bad ? 1 : result.exit_code();
  if (quiet_) {
    if (is_too_bad) fmt::print(stderr, "{}", notes.watchdog.closing_line());
    return code;
  }

  fmt::print("{}{}", notes.text(), crushed_note(result.crushed));
  if (result.resumed_from >= 0) fmt::print("resumed:  after frame {}\n", result.resumed_from);
  if (options_.images && result.last_frame >= 0)
    fmt::print("pictures: {}/frames/000000.png ... {:06}.png\n", options_.out.string(), result.last_frame);
  fmt::print("figures:  {}/stats.csv ({} frames)\n", options_.out.string(), result.last_frame + 1);
  if (!result.frozen_step.empty())
    fmt::print("frozen:   {} ({} group{}, {} contact{}); impinge step solves it\n", result.frozen_step.string(),
               result.frozen_groups, result.frozen_groups == 1 ? "" : "s", result.frozen_contacts,
               result.frozen_contacts == 1 ? "" : "s");
  for (const std::string& exported : result.exported) fmt::print("exported: {}\n", exported);
  if (!sheet.empty()) fmt::print("at once:  {}\n", sheet);
  if (filmed) fmt::print("video:    {}\n", video_.string());
  if (result.failures > 0) fmt::print("failed:   {} expectation{}\n", result.failures, result.failures == 1 ? "" : "s");
  fmt::print("{}", notes.watchdog.closing_line());
  return code;
}

}  // namespace

Entry<SubCommand> run_command() {
  return entry<SubCommand, RunCommand>("run", "simulate a scene and write its frames and figures into a folder");
}

}  // namespace impinge
