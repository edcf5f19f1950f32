// Other people's schedulers: a list of commands, and Slurm's job arrays. Both need only that all machines see the
// folder and the program under the same paths.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstring>
#include <map>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/io/child_process.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/sweep/progress.hpp"
#include "viewer/sweep/run.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTasks = 1000;  // Slurm's own limit is 1001 unless its administrator raised it

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

std::string folder_of(const fs::path& out) {
  std::string text = absolute_path(out).lexically_normal().string();
  if (text.size() > 1 && text.back() == '/') text.pop_back();
  return text;
}

struct Said {
  int code = -1;
  std::string out, err;
};

// a program of Slurm's, run without a shell
Said say(const std::vector<std::string>& words) {
  std::FILE *out = std::tmpfile(), *err = std::tmpfile();
  if (out == nullptr || err == nullptr)
    throw InputError("--engine slurm: no temporary file can be made; room in /tmp is wanted; free space");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(err), STDERR_FILENO);
  pid_t child = -1;
  const int failure = spawn(words, actions, child);
  posix_spawn_file_actions_destroy(&actions);
  Said said;
  if (failure == 0) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 255;
  } else {
    said.code = 127;
    said.err = std::strerror(failure);
  }
  const auto all = [](std::FILE* file) {
    std::string text;
    std::rewind(file);
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
    std::fclose(file);
    return text;
  };
  said.out = all(out);
  said.err += all(err);
  return said;
}

std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// tasks of an array that Slurm still knows of as waiting or running; -1 if it doesn't answer
int tasks_left(const std::string& id) {
  const Said said = say({"squeue", "--noheader", "--array", "--format=%T", "--jobs=" + id});
  if (said.code != 0) return said.err.find("Invalid job id") != std::string::npos ? 0 : -1;
  return static_cast<int>(std::count(said.out.begin(), said.out.end(), '\n'));
}

}  // namespace

std::string sweep_commands(const fs::path& out, const std::vector<SweepJob>& jobs, int repeats) {
  const std::string start = shell_word(own_program()) + " sweep --quiet --out " + shell_word(folder_of(out)) +
                            (repeats > 1 ? fmt::format(" --repeat {}", repeats) : "") + " --job ";
  std::string text;
  for (const SweepJob& job : jobs)
    if (!is_sweep_job_over(out, job, repeats)) text += start + job.hash + "\n";
  return text;
}

void run_sweep_on_slurm(const fs::path& out, const std::vector<SweepJob>& jobs, int repeats, int at_once,
                        bool shows_progress) {
  explain_interrupt("the job array is cancelled; the same command goes on with what it did");
  limit_interrupt(30.0);  // Slurm's own programs answer in their time, and the array must not stay behind
  std::vector<const SweepJob*> open;
  for (const SweepJob& job : jobs)
    if (!is_sweep_job_over(out, job, repeats)) open.push_back(&job);
  if (open.empty()) return;
  // a task takes every so-manyth job: an array has a largest size
  const std::size_t tasks = std::min(open.size(), kMostTasks);
  std::vector<std::string> lines(tasks);
  for (std::size_t i = 0; i < open.size(); ++i)
    lines[i % tasks] += (lines[i % tasks].empty() ? "" : ",") + open[i]->hash;
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const std::string folder = folder_of(out);
  make_folder(out / "slurm");
  write_file(out / "slurm/tasks.txt", text);
  std::string script = "#!/bin/sh\n# one task of the array: the jobs on its line of tasks.txt\n";
  script += "#SBATCH --job-name=impinge-sweep\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n";
  script +=
      fmt::format("jobs=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\n", shell_word(folder + "/slurm/tasks.txt"));
  script += fmt::format("exec {} sweep --quiet --out {}{} --job \"$jobs\"\n", shell_word(own_program()),
                        shell_word(folder), repeats > 1 ? fmt::format(" --repeat {}", repeats) : "");
  write_file(out / "slurm/array.sh", script);

  std::vector<std::string> words = {
      "sbatch",
      "--parsable",
      "--no-requeue",
      fmt::format("--array=0-{}{}", tasks - 1, at_once > 0 ? fmt::format("%{}", at_once) : ""),
      "--chdir=" + folder,
      "--output=" + folder + "/slurm/task-%A_%a.txt",
      folder + "/slurm/array.sh"};
  const Said submitted = say(words);
  if (submitted.code == 127)
    throw InputError(
        fmt::format("--engine slurm: sbatch can't be started ({}); Slurm's commands are wanted on this machine; "
                    "install them, or use --engine list",
                    one_line(submitted.err)));
  const std::string id = one_line(submitted.out).substr(0, one_line(submitted.out).find(';'));
  if (submitted.code != 0 || id.empty())
    throw InputError(
        fmt::format("--engine slurm: sbatch refused the array ({}); a cluster that takes it is wanted; "
                    "SBATCH_PARTITION, SBATCH_ACCOUNT and the like choose where it runs",
                    one_line(submitted.err)));

  SweepProgress progress(open.size(), shows_progress);
  for (int silent = 0;;) {
    for (int i = 0; i < 10 && !interrupted(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (interrupted()) {
      say({"scancel", id});
      break;
    }
    const int left = tasks_left(id);
    silent = left < 0 ? silent + 1 : 0;
    if (silent >= 300)
      throw InputError(
          fmt::format("--engine slurm: squeue has not answered for minutes; array {} may still run; the same command "
                      "goes on with what it did",
                      id));
    progress.set_run(static_cast<std::size_t>(std::count_if(
        open.begin(), open.end(), [&](const SweepJob* job) { return is_sweep_job_over(out, *job, repeats); })));
    progress.show(left < 0 ? 0 : static_cast<std::size_t>(left));
    if (left == 0) break;
  }
  progress.clear();
}

}  // namespace impinge
