// impinge sweep: one scene, many settings, a child process a job.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/report/sweep_report.hpp"
#include "viewer/sweep/collect.hpp"
#include "viewer/sweep/file.hpp"
#include "viewer/sweep/run.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

// refuses a folder that holds something else, before anything is written
void check_folder(const fs::path& out, const std::string& toml, bool resume) {
  std::error_code error;
  if (!fs::exists(out, error)) return;
  if (!fs::is_directory(out, error)) refuse(out.string(), "is a file", "a folder is wanted", "choose another --out");
  if (fs::exists(out / "sweep.toml")) {
    if (!resume && read_file(out / "sweep.toml", std::uint64_t{1} << 26) != toml)
      refuse(out.string(), "holds another sweep (its sweep.toml differs)", "the same sweep or a new folder is wanted",
             "add --resume to keep the jobs that both have, or choose another --out");
    return;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(out, error)) {
    const std::string name = entry.path().filename().string();
    if (name == "lock" || name == "sweep.toml.tmp") continue;
    if (fs::exists(out / "sweep.toml")) return check_folder(out, toml, resume);  // another process has just begun it
    refuse(out.string(), fmt::format("holds {} and no sweep", name), "a new or empty folder is wanted",
           "choose another --out");
  }
}

SweepJob checked_job(const fs::path& out, const std::string& hash) {
  const fs::path folder = job_folder(out, hash);
  if (!fs::is_regular_file(folder / "job.toml"))
    refuse("--job " + hash, fmt::format("{} holds no such job", (out / "jobs").string()),
           "the hash of a job of that sweep is wanted", "see its results.csv");
  const SweepJob job = read_sweep_job(folder);
  if (SweepBase(job.options).hash(job.changes) != hash)
    refuse((folder / "job.toml").string(),
           "its scene, script or surfaces, or the program, have changed since the sweep was planned",
           "the same input is wanted", "restore it, or sweep again into a new folder");
  return job;
}

int jobs_alone(const Arguments& arguments) {
  const fs::path out = arguments.run_options.out;
  const SweepOptions& options = arguments.sweep_options;
  std::vector<SweepJob> jobs;
  for (const std::string& hash : options.jobs_alone) jobs.push_back(checked_job(out, hash));
  run_sweep_jobs(out, jobs, options.repeats(), std::max(1, options.jobs), false);
  std::vector<SweepRow> rows;
  bool is_done = true;
  for (const SweepJob& job : jobs) {
    SweepRow& row = rows.emplace_back();
    row.hash = job.hash;
    measure_sweep_job(job_folder(out, job.hash), options.repeats(), row);
    is_done &= row.outcome.status == SweepOutcome::done;
  }
  if (!arguments.quiet) fmt::print("{}", sweep_summary({}, rows));
  if (interrupted()) return 130;
  return is_done ? 0 : 1;
}

void write_plan(const fs::path& out, const Sweep& sweep, const std::string& toml, bool resume) {
  make_folder(out);
  const FolderLock lock(out / "lock");
  check_folder(out, toml, resume);
  write_file(out / "sweep.toml", toml);
  for (const SweepJob& job : sweep.jobs) {
    make_folder(job_folder(out, job.hash));
    if (!fs::exists(job_folder(out, job.hash) / "job.toml")) write_sweep_job(job_folder(out, job.hash), job);
  }
}

int local_jobs(const SweepOptions& options) {
  return options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace

int sweep_command(const Arguments& given) {
  if (!given.sweep_options.jobs_alone.empty()) return jobs_alone(given);
  Arguments arguments = given;
  read_sweep_file(arguments.sweep_options, arguments.run_options);
  const SweepOptions& sweep_options = arguments.sweep_options;
  if (sweep_options.vary.empty())
    throw InputError(
        fmt::format("command line: no --vary, and no [sweep] vary in {}; at least one PATH=SPEC is wanted; add --vary "
                    "contact.friction=0.1,0.5",
                    given.run_options.scene.string()));
  RunOptions options = arguments.run_options;
  const fs::path out = options.out;
  options.export_ply = options.contacts = !sweep_options.reference.empty();
  options.resume = false;
  const SweepBase base(options);  // with the paths as given: they stand in the messages
  options.frames = base.last_frame();
  RunOptions anywhere = options;
  anywhere.scene = fs::absolute(options.scene).lexically_normal();
  if (!options.script.empty()) anywhere.script = fs::absolute(options.script).lexically_normal();
  Sweep sweep = plan_sweep(sweep_options, options, base);
  for (SweepJob& job : sweep.jobs) job.options = anywhere;
  const std::string toml = format_sweep_file(sweep_options, anywhere);
  check_folder(out, toml, arguments.run_options.resume);
  write_plan(out, sweep, toml, arguments.run_options.resume);

  const bool shows_progress = !arguments.quiet && isatty(STDERR_FILENO);
  if (sweep_options.engine == "list") {
    fmt::print("{}", sweep_commands(out, sweep.jobs, sweep_options.repeats()));
    return 0;
  }
  if (sweep_options.engine == "slurm")
    run_sweep_on_slurm(out, sweep.jobs, sweep_options.repeats(), sweep_options.jobs, shows_progress);
  else
    run_sweep_jobs(out, sweep.jobs, sweep_options.repeats(), local_jobs(sweep_options), shows_progress);

  const SweepTable table = collect_sweep(out, sweep, sweep_options, base);
  const std::string errors = describe_errors(sweep, table), summary = sweep_summary(table, sweep.rows) + errors;
  std::size_t done = 0;
  for (const SweepRow& row : sweep.rows) done += row.outcome.status == SweepOutcome::done ? 1 : 0;
  {
    const FolderLock lock(out / "lock");
    write_file(out / "results.csv", sweep_csv(table, sweep.rows));
    write_file(out / "summary.txt", fmt::format("{}: {} of {} jobs done\n\n{}", options.scene.filename().string(), done,
                                                sweep.rows.size(), summary));
    write_sweep_report(out,
                       {options.scene.filename().string(), sweep_options.zip, sweep.paths, sweep.reference_words,
                        errors, base.session().world().parameters.simulation.frame_time * base.last_frame()},
                       base.session());
  }
  if (!arguments.quiet)
    fmt::print("{}{} of {} jobs done\nresults: {}\nreport:  {}\n", summary, done, sweep.rows.size(),
               (out / "results.csv").string(), (out / "report.html").string());
  if (interrupted()) {
    fmt::print(stderr, "interrupted; the same command goes on\n");
    return 130;
  }
  const bool lacks_reference = std::any_of(sweep.rows.begin(), sweep.rows.end(), [&](const SweepRow& row) {
    return !row.reference.empty() && read_sweep_outcome(job_folder(out, row.reference)).status > SweepOutcome::failed;
  });
  return done == sweep.rows.size() && !lacks_reference ? 0 : 1;
}

}  // namespace impinge
