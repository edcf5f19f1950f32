// The processes of a sweep: one child a job, one lock a job.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/toml.hpp"
#include "viewer/sweep/job.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> words_of(const fs::path& folder, const SweepJob& job) {
  const RunOptions& o = job.options;
  // there may be thousands
  std::vector<std::string> words = {"impinge",   "run", o.scene.string(), "--out", (folder / "run").string(),
                                    "--threads", "1",   "--snapshots",    "8",     "--resume"};
  const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
  if (!o.script.empty()) add({"--script", o.script.string()});
  if (o.frames) add({"--frames", std::to_string(*o.frames)});
  for (const std::string& text : o.overrides) add({"--set", text});
  for (const std::string& text : job.changes) add({"--set", text});
  if (given_memory_limit() > 0) add({"--memory-limit", std::to_string(given_memory_limit())});
  if (o.judge) add({o.judge_substeps ? "--judge=substeps" : "--judge"});
  if (o.contacts) add({"--contacts"});
  if (o.export_ply) add({"--export", "ply"});
  if (o.images)
    add({"--size", fmt::format("{}x{}", o.width, o.height)});
  else
    add({"--no-images"});
  return words;
}

// the line that says why: a divergence if there is one, else the first that is no mere note
std::string reason_in(const fs::path& output) {
  const std::string text = is_file(output) ? read_file(output, std::uint64_t{1} << 30) : "";
  const std::size_t diverged = text.rfind("diverged: ");
  std::size_t begin = diverged == std::string::npos ? 0 : diverged + 10;
  while (text.compare(begin, 6, "note: ") == 0 && text.find('\n', begin) != std::string::npos)
    begin = text.find('\n', begin) + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

SweepOutcome outcome_of(int status, const fs::path& output) {
  SweepOutcome outcome;
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGTERM || signal == SIGINT) {  // asked to stop before it could listen
      outcome.status = SweepOutcome::interrupted;
      return outcome;
    }
    outcome.status = SweepOutcome::crashed;
    outcome.reason = fmt::format("ended by signal {} ({})", signal, strsignal(signal));
    return outcome;
  }
  switch (WEXITSTATUS(status)) {
    case 0:
      outcome.status = SweepOutcome::done;
      return outcome;
    case 1:
      outcome.status = SweepOutcome::failed;
      break;
    case 2:
      outcome.status = SweepOutcome::refused;
      break;
    case 3:
      outcome.status = SweepOutcome::diverged;
      break;
    case 130:
      outcome.status = SweepOutcome::interrupted;
      return outcome;
    default:
      outcome.status = SweepOutcome::crashed;
  }
  outcome.reason = reason_in(output);
  if (outcome.reason.empty()) outcome.reason = fmt::format("exit code {}", WEXITSTATUS(status));
  return outcome;
}

// only what is safe between fork and exec
[[noreturn]] void become_run(char* const* words, int lock, int output, pid_t parent) {
  setpgid(0, 0);  // a Ctrl-C reaches the sweep, which passes it on once; blocked here, it waits there
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // no run outlives its sweep
  if (getppid() != parent) _exit(130);
  fcntl(lock, F_SETFD, 0);  // the run holds the lock too: nobody else starts on the folder before it is gone
  std::signal(SIGINT, SIG_DFL), std::signal(SIGTERM, SIG_DFL);
  if (dup2(output, STDOUT_FILENO) < 0 || dup2(output, STDERR_FILENO) < 0) _exit(127);
  execv("/proc/self/exe", words);
  _exit(127);
}

}  // namespace

SweepWorker::Start SweepWorker::start(const fs::path& folder, const SweepJob& job) {
  folder_ = folder;
  std::optional<FolderLock> lock = FolderLock::try_take(folder);
  if (!lock) return busy;
  std::error_code error;
  if (is_there(folder / "done")) {
    outcome_ = read_sweep_outcome(folder);
    if (has_what_was_asked(folder, job)) return already_done;
    fs::remove_all(folder / "run/snapshots", error);  // or it would go on behind what is gone
    fs::remove(folder / "done", error);
  }
  fs::remove(folder / "failed", error);
  const fs::path file = folder / "output.txt";
  const int output = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (output < 0) {
    throw InputError(fmt::format("{}: can't be written ({}); free space or choose another --out", file.string(),
                                 std::strerror(errno)));
  }
  std::vector<std::string> words = words_of(folder, job);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  begin_ = std::chrono::steady_clock::now();
  const pid_t parent = getpid();
  const pid_t child = fork();
  const int code = errno;
  if (child == 0) become_run(pointers.data(), lock->handle(), output, parent);
  close(output);
  if (child < 0)
    throw InputError(fmt::format("command line: no process can be started ({}); fewer are wanted; lower --jobs",
                                 std::strerror(code)));
  child_.emplace(child);
  lock_ = std::move(*lock);
  return started;
}

bool SweepWorker::poll() {
  const std::optional<int> status = child_->poll();
  if (!status) return false;
  outcome_ = outcome_of(*status, folder_ / "output.txt");
  outcome_.wall_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
  if (outcome_.status != SweepOutcome::interrupted)
    write_file(folder_ / (outcome_.is_final() ? "done" : "failed"),
               fmt::format("status = \"{}\"\nreason = {}\nwall_ms = {:.3f}\n", status_name(outcome_.status),
                           toml_string(outcome_.reason), outcome_.wall_ms));
  lock_ = {};
  return true;
}

void SweepWorker::wait_for_any(std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  siginfo_t info{};
  do {  // WNOWAIT leaves the child to poll()
    if (waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (std::chrono::steady_clock::now() < end);
}

void SweepWorker::interrupt() const { kill(child_->pid(), SIGTERM); }

}  // namespace impinge
