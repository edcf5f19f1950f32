#include "viewer/present/video.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"

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

}  // namespace

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
  for (const std::vector<std::string>& codec :
       {std::vector<std::string>{"libx264", "-preset", "medium", "-crf", "18"}, {"mpeg4", "-q:v", "2"}}) {
    std::vector<std::string> words = {"ffmpeg",
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
                                      "[0-9][0-9][0-9][0-9][0-9][0-9].png",
                                      "-vf",
                                      "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709",
                                      "-c:v"};
    words.insert(words.end(), codec.begin(), codec.end());
    for (const char* word :
         {"-pix_fmt", "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"})
      words.emplace_back(word);
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
