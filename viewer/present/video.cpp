#include "viewer/present/video.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

struct Outcome {
  bool installed = true, succeeded = false;
  std::string complaint;  // what the program wrote to its standard error
};

/// Runs `words[0]`, found on PATH, in `folder`, without a shell, and waits for its end.
Outcome run_program(const std::vector<std::string>& words, const fs::path& folder) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw InputError(fmt::format("{}: can't be run ({})", words[0], std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int error = spawn(words, actions, child);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);

  Outcome outcome;
  if (error == 0) {
    ChildProcess program(child);
    outcome.complaint = ChildProcess::read_all(ends[0], 4096);
    const int status = program.wait();
    outcome.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  if (error != 0) close(ends[0]);
  if (error == ENOENT)
    outcome.installed = false;
  else if (error != 0)
    outcome.complaint = std::strerror(error);
  return outcome;
}

bool is_frame(const fs::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == ".png" && stem.size() == 6 &&
         std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Whether a picture has alpha, by its header.
bool has_alpha(const fs::path& picture) {
  std::string head(26, '\0');
  std::ifstream(picture, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head[25] == 4 || head[25] == 6;
}

bool any_has_alpha(const fs::path& folder) {
  const std::vector<std::string> names = names_in(folder);
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return is_frame(name) && has_alpha(folder / name); });
}

void require_frames(const fs::path& folder) {
  for (const std::string& name : names_in(folder))
    if (is_frame(name)) return;
  throw InputError(folder.string() + ": has no frames; files such as 000000.png are wanted; run the scene first");
}

/// Without the part that ffmpeg puts before it, which holds an address in memory: "[png @ 0x55d0]".
std::string first_line(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  const std::size_t end = line.find("] ");
  if (line.starts_with('[') && end != std::string::npos) line.erase(0, end + 2);
  return line.empty() ? "it gave no reason" : line;
}

using Arguments = std::vector<std::string>;

/// What ffmpeg is told of the output, one set of words after another until one succeeds.
std::vector<Arguments> ways_to_write(const std::string& ending, double frames_per_second, bool is_transparent) {
  if (ending == ".gif") {
    constexpr double kFastest = 50.0;  // many viewers take a shorter delay than two hundredths for ten
    const double rate = frames_per_second / std::ceil(frames_per_second / kFastest);
    // colours of its own for all pictures; dithered by a fixed pattern, so that what stands still stays the same
    return {{"-vf",
             fmt::format("fps={},split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=bayer", rate),
             "-loop", "0"}};
  }
  if (ending == ".webp") {
    Arguments words = {"-c:v", "libwebp_anim", "-quality", "85", "-loop", "0"};
    if (is_transparent) words.insert(words.end(), {"-pix_fmt", "yuva420p"});
    return {words};
  }
  // laid over the grey that stands for nothing elsewhere too
  const std::string opaque =
      is_transparent
          ? fmt::format("format=rgba,split[a][b];[a]lutrgb=r={}:g={}:b={}:a=255[c];[c][b]overlay=format=rgb,",
                        kBehind[0], kBehind[1], kBehind[2])
          : "";
  std::vector<Arguments> ways;
  for (const Arguments& codec :
       {Arguments{"libx264", "-preset", "medium", "-crf", "18"}, Arguments{"mpeg4", "-q:v", "2"}}) {
    Arguments words = {"-vf", opaque + "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709", "-c:v"};
    words.insert(words.end(), codec.begin(), codec.end());
    for (const char* word :
         {"-pix_fmt", "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"})
      words.emplace_back(word);
    ways.push_back(std::move(words));
  }
  return ways;
}

}  // namespace

const std::vector<std::string>& video_endings() {
  static const std::vector<std::string> endings = {".mp4", ".mkv", ".mov", ".avi", ".gif", ".webp"};
  return endings;
}

bool has_ffmpeg() {
  const char* path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "/bin:/usr/bin";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const fs::path program = fs::path(folders.substr(begin, end - begin)) / "ffmpeg";
    std::error_code error;
    if (fs::is_regular_file(program, error) && access(program.c_str(), X_OK) == 0) return true;
    begin = end + 1;
  }
  return false;
}

bool make_video(const fs::path& frames, const fs::path& output, double frames_per_second) {
  if (!(frames_per_second > 0) || !std::isfinite(frames_per_second))
    throw InputError(
        fmt::format("{}: {} frames a second; a positive number is wanted; try 30", output.string(), frames_per_second));
  require_frames(frames);
  // ffmpeg runs in the frames' folder, as its patterns have no way to quote a folder's name; so its output is absolute
  const fs::path target = absolute_path(output);
  const fs::path temporary = temporary_name(target, true);
  struct Removed {
    const fs::path& path;
    ~Removed() {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  } removed{temporary};
  std::string complaint;
  for (const Arguments& way : ways_to_write(output.extension().string(), frames_per_second, any_has_alpha(frames))) {
    Arguments words = {"ffmpeg",
                       "-nostdin",
                       "-loglevel",
                       "error",
                       "-xerror",
                       "-y",
                       "-f",
                       "image2",
                       "-framerate",
                       fmt::format("{}", frames_per_second),
                       "-pattern_type",
                       "glob",
                       "-i",
                       "[0-9][0-9][0-9][0-9][0-9][0-9].png"};
    words.insert(words.end(), way.begin(), way.end());
    words.push_back(temporary.string());
    const Outcome outcome = run_program(words, frames);
    if (!outcome.installed) return false;
    if (outcome.succeeded) {
      std::error_code error;
      fs::rename(temporary, target, error);
      if (!error) return true;
      throw InputError(fmt::format("{}: can't be written ({}); choose another name", output.string(), error.message()));
    }
    if (complaint.empty()) complaint = first_line(outcome.complaint);
  }
  throw InputError(
      fmt::format("{}: ffmpeg made no film ({}); whole frames of one size and a name such as film.mp4 are wanted; "
                  "check them",
                  output.string(), complaint));
}

}  // namespace impinge
