// impinge sweep: one scene, many settings, a child process a job.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <deque>
#include <map>
#include <set>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/scene_values.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/app/sweep_report.hpp"
#include "viewer/app/sweep_values.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostUnasked = 10'000, kMost = 10'000'000;

std::atomic<bool> g_interrupted{false};

// the first signal lets the runs end after their frame in work; the second ends everything at once
void on_interrupt(int signal) {
  g_interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

fs::path job_folder(const fs::path& out, const std::string& hash) { return out / "jobs" / hash; }

// one line on a terminal: how far, and how long at the present pace
class SweepProgress {
 public:
  SweepProgress(std::size_t jobs, bool shows) : jobs_(jobs), shows_(shows) {}
  void ended(bool was_run) { was_run ? ++run_ : ++skipped_; }
  void show(std::size_t running) {
    if (!shows_) return;
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - last_).count() < 0.2) return;
    last_ = now;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    const std::size_t done = run_ + skipped_;
    fmt::print(stderr, "\rjobs {}/{}  running {}{}\x1b[K", done, jobs_, running, run_ > 0 ? fmt::format("  {:.0f} s left", seconds / static_cast<double>(run_) * static_cast<double>(jobs_ - done)) : "");
    std::fflush(stderr);
  }
  void clear() const {
    if (shows_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  std::size_t jobs_, run_ = 0, skipped_ = 0;
  bool shows_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_;
};

// every job once, `at_once` at a time; a job that another process works on is come back to
void run_jobs(const fs::path& out, const std::vector<SweepJob>& jobs, int at_once, bool shows_progress) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  setenv("LP_NUM_THREADS", "1", 1);  // the renderer's threads: a job has one
  SweepProgress progress(jobs.size(), shows_progress);
  std::deque<const SweepJob*> waiting;
  for (const SweepJob& job : jobs) waiting.push_back(&job);
  std::vector<SweepWorker> running;
  bool told = false;
  while (!running.empty() || (!waiting.empty() && !g_interrupted)) {
    std::size_t tries = waiting.size();
    while (!g_interrupted && tries-- > 0 && running.size() < static_cast<std::size_t>(at_once)) {
      const SweepJob* job = waiting.front();
      waiting.pop_front();
      SweepWorker worker;
      switch (worker.start(job_folder(out, job->hash), *job)) {
        case SweepWorker::started: running.push_back(worker); break;
        case SweepWorker::busy: waiting.push_back(job); break;
        case SweepWorker::already_done: progress.ended(false);
      }
    }
    if (g_interrupted && !told)
      for (const SweepWorker& worker : running) worker.interrupt();
    told = g_interrupted;
    std::this_thread::sleep_for(std::chrono::milliseconds(running.empty() ? 50 : 5));
    std::erase_if(running, [&](SweepWorker& worker) {
      const bool ended = worker.poll();
      if (ended) progress.ended(true);
      return ended;
    });
    progress.show(running.size());
  }
  progress.clear();
}

std::string quoted(const std::vector<std::string>& texts) {
  std::string out = "[";
  for (const std::string& text : texts) out += (out.size() > 1 ? ", " : "") + toml_string(text);
  return out + "]";
}

// what tells a sweep from another in the same folder
std::string sweep_toml(const Arguments& arguments, const RunOptions& o) {
  return fmt::format("# a sweep; the same impinge sweep goes on with it\nversion = \"{}\"\nscene = {}\nscript = {}\nset = {}\nvary = {}\nzip = {}\nreference = {}\nframes = {}\nsize = [{}, {}]\nimages = {}\n",
                     IMPINGE_VERSION, toml_string(o.scene.string()), toml_string(o.script.string()), quoted(o.overrides), quoted(arguments.vary), arguments.zip, quoted(arguments.reference),
                     o.frames.value_or(0), o.width, o.height, o.images);
}

// refuses a folder that holds something else, before anything is written
void check_folder(const fs::path& out, const std::string& toml, bool resume) {
  std::error_code error;
  if (!fs::exists(out, error)) return;
  if (!fs::is_directory(out, error)) refuse(out.string(), "is a file", "a folder is wanted", "choose another --out");
  if (fs::exists(out / "sweep.toml")) {
    if (!resume && read_file(out / "sweep.toml", std::uint64_t{1} << 26) != toml)
      refuse(out.string(), "holds another sweep (its sweep.toml differs)", "the same sweep or a new folder is wanted", "add --resume to keep the jobs that both have, or choose another --out");
    return;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(out, error)) {
    const std::string name = entry.path().filename().string();
    if (name == "lock" || name == "sweep.toml.tmp") continue;
    if (fs::exists(out / "sweep.toml")) return check_folder(out, toml, resume);  // another process has just begun it
    refuse(out.string(), fmt::format("holds {} and no sweep", name), "a new or empty folder is wanted", "choose another --out");
  }
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: can't be made ({}); a folder that may be written to is wanted; choose another --out", folder.string(), error.message()));
}

std::vector<std::string> moving_bodies(const Session& session) {
  std::vector<std::string> names;
  for (const TomlNode& body : session.scene().bodies) {
    const TomlEntry *name = body.find("name"), *kind = body.find("kind");
    if (name != nullptr && kind != nullptr && (kind->value.string == "dynamic" || kind->value.string == "deformable")) names.push_back(name->value.string);
  }
  return names;
}

// the reference's settings in place of the job's own
std::vector<std::string> with_reference(std::vector<std::string> changes, const std::vector<std::string>& reference) {
  for (const std::string& text : reference) {
    const std::string path = text.substr(0, text.find('=') + 1);
    std::erase_if(changes, [&](const std::string& change) { return change.rfind(path, 0) == 0; });
    changes.push_back(text);
  }
  return changes;
}

struct Sweep {
  std::vector<std::string> paths;
  std::vector<SweepRow> rows;    ///< without figures
  std::vector<SweepJob> jobs;    ///< what to run: references first, each hash once
};

Sweep plan(const Arguments& arguments, const RunOptions& options, const SweepBase& base) {
  const auto load = [&](const std::string& text) {
    std::vector<std::string> overrides = options.overrides;
    overrides.push_back(text);
    const Session tried(options.scene, overrides, options.script, {options.width, options.height, false});
  };
  std::vector<SweepAxis> axes;
  Sweep sweep;
  for (const std::string& text : arguments.vary) {
    axes.push_back(read_sweep_axis(text, base.session(), load));
    sweep.paths.push_back(axes.back().path);
    for (const std::string& set : options.overrides)
      if (set.rfind(axes.back().path + "=", 0) == 0) refuse("--vary " + text, "a path that --set gives too", "one of them is wanted", "leave one out");
  }
  const std::size_t count = count_sweep_jobs(axes, arguments.zip, arguments.yes ? kMost : kMostUnasked);
  std::vector<std::string> reference;
  for (const std::string& text : arguments.reference) {
    try {
      const SweepAxis axis = read_sweep_axis(text, base.session(), load);
      if (axis.values.size() != 1) refuse("--vary " + text, fmt::format("{} values", axis.values.size()), "one is wanted", "leave the others out");
      reference.push_back(axis.path + "=" + axis.values.front());
    } catch (const InputError& error) {
      const std::string message = error.what();
      throw InputError("--reference" + message.substr(6));
    }
  }
  std::vector<SweepJob> own, references;
  std::set<std::string> known;
  const auto add = [&](std::vector<SweepJob>& list, const std::vector<std::string>& changes, const std::string& against) {
    SweepJob job{options, changes, base.hash(changes), against};
    if (known.insert(job.hash).second) list.push_back(job);
    return job.hash;
  };
  for (std::size_t i = 0; i < count; ++i) {
    SweepRow row;
    row.values = sweep_job_values(axes, arguments.zip, i);
    std::vector<std::string> changes;
    for (std::size_t k = 0; k < axes.size(); ++k) changes.push_back(axes[k].path + "=" + row.values[k]);
    if (!reference.empty()) row.reference = add(references, with_reference(changes, reference), "");
    row.hash = add(own, changes, row.reference);
    sweep.rows.push_back(row);
  }
  sweep.jobs = references;
  sweep.jobs.insert(sweep.jobs.end(), own.begin(), own.end());
  return sweep;
}

void measure(const fs::path& out, Sweep& sweep, const std::vector<std::string>& bodies) {
  for (SweepRow& row : sweep.rows) {
    const fs::path folder = job_folder(out, row.hash);
    measure_sweep_job(folder, row);
    if (row.reference.empty() || row.outcome.status > SweepOutcome::failed) continue;
    const fs::path reference = job_folder(out, row.reference);
    if (read_sweep_outcome(reference).status > SweepOutcome::failed) continue;
    const SurfaceDistance distance = surface_distance(folder / "run", reference / "run", bodies);
    row.error = distance.rms;
    if (distance.scene_size > 0) row.relative_error = distance.rms / distance.scene_size;
  }
}

int one_job(const Arguments& arguments) {
  const fs::path out = arguments.run_options.out, folder = job_folder(out, arguments.job);
  if (!fs::is_regular_file(folder / "job.toml")) refuse("--job " + arguments.job, fmt::format("{} holds no such job", (out / "jobs").string()), "the hash of a job of that sweep is wanted", "see its results.csv");
  const SweepJob job = read_sweep_job(folder);
  if (SweepBase(job.options).hash(job.changes) != arguments.job)
    refuse((folder / "job.toml").string(), "its scene, script or surfaces, or the program, have changed since the sweep was planned", "the same input is wanted", "restore it, or sweep again into a new folder");
  run_jobs(out, {job}, 1, false);
  SweepRow row;
  row.hash = job.hash;
  row.values = {};
  measure_sweep_job(folder, row);
  if (!arguments.quiet) fmt::print("{}", sweep_summary({}, {row}, false));
  if (g_interrupted) return 130;
  return row.outcome.status == SweepOutcome::done ? 0 : 1;
}

}  // namespace

int sweep_command(const Arguments& arguments) {
  if (!arguments.job.empty()) return one_job(arguments);
  RunOptions options = arguments.run_options;
  const fs::path out = options.out;
  options.export_ply = !arguments.reference.empty();
  options.resume = false;
  const SweepBase base(options);  // with the paths as given: they stand in the messages
  options.frames = base.last_frame();
  RunOptions anywhere = options;
  anywhere.scene = fs::absolute(options.scene).lexically_normal();
  if (!options.script.empty()) anywhere.script = fs::absolute(options.script).lexically_normal();
  Sweep sweep = plan(arguments, options, base);
  for (SweepJob& job : sweep.jobs) job.options = anywhere;
  const std::string toml = sweep_toml(arguments, anywhere);
  check_folder(out, toml, arguments.run_options.resume);

  make_folder(out);
  {
    const FolderLock lock(out / "lock");
    check_folder(out, toml, arguments.run_options.resume);
    write_file(out / "sweep.toml", toml);
    for (const SweepJob& job : sweep.jobs) {
      make_folder(job_folder(out, job.hash));
      if (!fs::exists(job_folder(out, job.hash) / "job.toml")) write_sweep_job(job_folder(out, job.hash), job);
    }
  }
  run_jobs(out, sweep.jobs, arguments.jobs, !arguments.quiet && isatty(STDERR_FILENO));
  measure(out, sweep, moving_bodies(base.session()));
  std::size_t done = 0;
  for (const SweepRow& row : sweep.rows) done += row.outcome.status == SweepOutcome::done ? 1 : 0;
  const bool has_reference = !arguments.reference.empty();
  {
    const FolderLock lock(out / "lock");
    write_file(out / "results.csv", sweep_csv(sweep.paths, sweep.rows, has_reference));
    SweepReport report{options.scene.filename().string(), "", sweep.paths, arguments.reference, sweep.rows, base.session().world().parameters.simulation.frame_time * base.last_frame()};
    for (const std::string& text : arguments.vary) report.command += (report.command.empty() ? "varied: " : arguments.zip ? " with " : " and ") + text;
    write_sweep_report(out, report);
  }
  if (!arguments.quiet) {
    fmt::print("{}{} of {} jobs done\nresults: {}\nreport:  {}\n", sweep_summary(sweep.paths, sweep.rows, has_reference), done, sweep.rows.size(), (out / "results.csv").string(),
               (out / "report.html").string());
  }
  if (g_interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on\n");
    return 130;
  }
  return done == sweep.rows.size() ? 0 : 1;
}

}  // namespace impinge
