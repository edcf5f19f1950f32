// impinge sweep: one scene, many settings, a child process a job.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/former_paths.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/app/shared_options.hpp"
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
  if (!is_there(out)) return;
  if (!is_folder(out)) refuse(out.string(), "is a file", "a folder is wanted", "choose another --out");
  if (is_there(out / "sweep.toml")) {
    if (!resume && read_file(out / "sweep.toml", std::uint64_t{1} << 26) != toml)
      refuse(out.string(), "holds another sweep (its sweep.toml differs)", "the same sweep or a new folder is wanted",
             "add --resume to keep the jobs that both have, or choose another --out");
    return;
  }
  for (const std::string& name : names_in(out)) {
    if (name == FolderLock::kName || is_temporary_name(name)) continue;
    if (is_there(out / "sweep.toml")) return check_folder(out, toml, resume);  // another process has just begun it
    refuse(out.string(), fmt::format("holds {} and no sweep", name), "a new or empty folder is wanted",
           "choose another --out");
  }
}

SweepJob checked_job(const fs::path& out, const std::string& hash) {
  const fs::path folder = job_folder(out, hash);
  if (!is_file(folder / "job.toml"))
    refuse("--job " + hash, fmt::format("{} holds no such job", (out / "jobs").string()),
           "the hash of a job of that sweep is wanted", "see its results.csv");
  SweepJob job = read_sweep_job(folder);
  if (SweepBase(job.options).hash(job.changes) != hash)
    refuse((folder / "job.toml").string(),
           "its scene, script or surfaces, or the program, have changed since the sweep was planned",
           "the same input is wanted", "restore it, or sweep again into a new folder");
  return job;
}

int jobs_alone(const fs::path& out, const SweepOptions& options, bool quiet) {
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
  if (!quiet) fmt::print("{}", sweep_summary({}, rows));
  if (interrupted()) return 130;
  return is_done ? 0 : 1;
}

/// Every `word` in the text by itself: what is before and after it is no part of a path.
std::string with_word_replaced(std::string text, const std::string& word, const std::string& other) {
  const auto is_path = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    const std::size_t end = at + word.size();
    const bool whole = (at == 0 || !is_path(text[at - 1])) && (end == text.size() || !is_path(text[end]));
    if (whole) text.replace(at, word.size(), other);
    at += whole ? other.size() : word.size();
  }
  return text;
}

/// Present paths for former ones in all that the sweep is asked; says so once. One that stands for several parameters
/// stays the name of its axis.
void rename_former_paths(const Session& session, SweepOptions& sweep, std::vector<std::string>& overrides) {
  const ParameterSet& rows = session.rows();
  std::vector<std::string> used = session.scene().former_paths;
  used.insert(used.end(), session.script().former_paths().begin(), session.script().former_paths().end());
  overrides = renamed_overrides(overrides, rows, used);
  const auto rename = [&](SweepSetting& setting) {
    for (const auto& [former, present] : rows.former_paths()) {
      const std::string renamed = with_word_replaced(setting.text, former, present.front());
      if (renamed == setting.text) continue;
      used.push_back(former);
      if (present.size() == 1) setting.text = renamed;
    }
  };
  for (auto* settings : {&sweep.vary, &sweep.reference, &sweep.columns})
    for (SweepSetting& setting : *settings) rename(setting);
  rename(sweep.filter);
  if (!used.empty()) fmt::print(stderr, "note: {}\n", rows.note_of_former(used));
}

void write_plan(const fs::path& out, const Sweep& sweep, const std::string& toml, bool resume) {
  make_folder(out);
  const FolderLock lock = FolderLock::wait_for(out);
  check_folder(out, toml, resume);
  write_file(out / "sweep.toml", toml);
  for (const SweepJob& job : sweep.jobs) {
    make_folder(job_folder(out, job.hash));
    if (!is_there(job_folder(out, job.hash) / "job.toml")) write_sweep_job(job_folder(out, job.hash), job);
  }
}

int local_jobs(const SweepOptions& options) {
  return options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// `given`: as the command line says it; a file's [sweep] table may say more.
int sweep(SweepOptions sweep_options, const RunOptions& given, bool quiet) {
  RunOptions options = given;
  read_sweep_file(sweep_options, options);
  if (sweep_options.vary.empty())
    throw InputError(
        fmt::format("command line: no --vary, and no [sweep] vary in {}; at least one PATH=SPEC is wanted; add --vary "
                    "contact.friction=0.1,0.5",
                    given.scene.string()));
  if (options.script == "-")
    throw InputError(
        "command line: --script - with sweep, whose jobs are processes of their own and read the script each; "
        "a file is wanted; name one");
  const fs::path out = options.out;
  options.export_ply = options.contacts = !sweep_options.reference.empty();
  options.resume = false;
  const SweepBase base(options);               // with the paths as given: they stand in the messages
  options.judge = base.session().is_judged();  // a run.toml may say so
  options.judge_substeps = base.session().is_judged_by_substep();
  rename_former_paths(base.session(), sweep_options, options.overrides);
  options.frames = base.last_frame();
  RunOptions anywhere = options;
  anywhere.scene = absolute_path(options.scene).lexically_normal();
  if (!options.script.empty()) anywhere.script = absolute_path(options.script).lexically_normal();
  Sweep sweep = plan_sweep(sweep_options, options, base);
  for (SweepJob& job : sweep.jobs) job.options = anywhere;
  const std::string toml = format_sweep_file(sweep_options, anywhere);
  check_folder(out, toml, given.resume);
  write_plan(out, sweep, toml, given.resume);

  const bool shows_progress = !quiet && isatty(STDERR_FILENO);
  if (sweep_options.engine == "list") {
    fmt::print("{}", sweep_commands(out, sweep.jobs, sweep_options.repeats()));
    return 0;
  }
  if (sweep_options.engine == "slurm")
    run_sweep_on_slurm(out, sweep.jobs, sweep_options.repeats(), sweep_options.jobs, shows_progress);
  else
    run_sweep_jobs(out, sweep.jobs, sweep_options.repeats(), local_jobs(sweep_options), shows_progress);

  const InterruptScope to_the_end(nullptr);  // what there is by now is collected, interrupted or not
  const SweepTable table = collect_sweep(out, sweep, sweep_options, base);
  const std::string errors = describe_errors(sweep, table), caution = reference_caution(sweep),
                    summary = (caution.empty() ? "" : "caution: " + caution + "\n\n") +
                              sweep_summary(table, sweep.rows) + errors;
  std::size_t done = 0, doubted = 0;
  for (const SweepRow& row : sweep.rows) {
    done += row.outcome.status == SweepOutcome::done ? 1 : 0;
    doubted += row.outcome.status == SweepOutcome::done && !row.doubts.empty() ? 1 : 0;
  }
  const std::string count = fmt::format(
      "{} of {} jobs done{}", done, sweep.rows.size(),
      doubted == 0 ? "" : fmt::format(", {} of them in doubt (the column doubts of results.csv says why)", doubted));
  {
    const FolderLock lock = FolderLock::wait_for(out);
    write_file(out / "results.csv", sweep_csv(table, sweep.rows));
    write_file(out / "summary.txt", fmt::format("{}: {}\n\n{}", options.scene.filename().string(), count, summary));
    write_sweep_report(out,
                       {options.scene.filename().string(), sweep_options.zip, sweep.paths, sweep.reference_words,
                        errors, caution, base.session().world().parameters.simulation.frame_time * base.last_frame()},
                       base.session());
  }
  if (!quiet)
    fmt::print("{}{}\nresults: {}\nreport:  {}\n", summary, count, (out / "results.csv").string(),
               (out / "report.html").string());
  if (interrupted()) {
    fmt::print(stderr, "interrupted; the same command goes on\n");
    return 130;
  }
  const bool lacks_reference = std::any_of(sweep.rows.begin(), sweep.rows.end(), [&](const SweepRow& row) {
    return !row.reference.empty() && read_sweep_outcome(job_folder(out, row.reference)).status > SweepOutcome::failed;
  });
  return done == sweep.rows.size() && !lacks_reference ? 0 : 1;
}

class SweepCommand : public SubCommand {
 public:
  void declare(Options& options) override;
  int run() override;

 private:
  void check_engine() const;

  RunOptions run_;
  SweepOptions sweep_;
  std::vector<std::string> vary_, reference_, columns_;
  bool quiet_ = false;
};

void SweepCommand::declare(Options& options) {
  options.optional_word(
      "SCENE", run_.scene,
      "scene file (TOML), or the run.toml of a run, or a file with a [sweep] table that says the rest");
  set_option(options, run_.overrides, "PATH=VALUE: the same in every job; one or more");
  memory_option(options);
  options.texts("--vary", vary_,
                "PATH=a,b,c or PATH=lo:hi:n or PATH=log(lo,hi,n), one or more: a job for each value, and for each "
                "combination of the values of several");
  options.flag("--zip", sweep_.zip,
               "the first values of all --vary together, then the second ones, ..., instead of all combinations");
  options.text("--filter", sweep_.filter.text,
               "EXPR: only combinations for which it holds, such as 'simulation.substeps <= 8 || response.method == "
               "\"penalty\"'");
  options.texts("--reference", reference_,
                "PATH=VALUE, one or more: each job's errors are against the same job with these settings, and with the "
                "scene's methods where they name none; or 'finest': against the job with the sweep's smallest time "
                "step; or 'case:NAME': against a formula (see impinge list cases)");
  options.text("--window", sweep_.window.text,
               "seconds that errors are taken over; 'all'; or 'automatic' (default): as long as a reference run "
               "started 1e-9 scene sizes aside stays within 1e-3 of it");
  options.texts("--column", columns_,
                "NAME=EXPR, one or more: a further column each, over last(), max(), min(), mean(), sum() of a column "
                "of stats.csv and over varied paths");
  options.whole("--repeat", sweep_.repeat, 1, 1000,
                "runs of each job: columns of times are then medians, with columns spread_..._ms (largest less "
                "smallest)");
  options.flag("--coarse-first", sweep_.coarse_first,
               "run the ends and middles of all ranges first; changes no result");
  script_option(options, run_.script);
  frames_option(options, run_.frames);
  const auto take_size = [this](int width, int height) {
    run_.width = width, run_.height = height, sweep_.size_given = true;
  };
  options.size("--size", take_size, "WIDTHxHEIGHT of the pictures (default: 1280x720)");
  images_option(options, run_.images);
  judge_option(options, run_);
  options.whole("--jobs", sweep_.jobs, 1, 4096,
                "jobs at once, each in a process and on a thread of its own (default: all cores; with slurm: as many "
                "as it gives)");
  options.text("--engine", sweep_.engine,
               "local: run here (default); list: print a command a job, for GNU parallel or a render farm; slurm: "
               "submit a job array, wait and collect");
  options.names("--job", sweep_.jobs_alone, "HASH[,HASH...]: run only these jobs of the sweep in --out");
  options.path("--out", run_.out, "folder to write to (default: out/SCENE-sweep)");
  options.flag("--resume", run_.resume,
               "take a folder that holds another sweep too, and keep the jobs that both have (the same sweep always "
               "goes on)");
  options.flag("--yes", sweep_.yes, "more than 10000 jobs are meant");
  quiet_option(options, quiet_);
}

void SweepCommand::check_engine() const {
  const std::vector<std::string> engines = {"local", "list", "slurm"};
  if (std::find(engines.begin(), engines.end(), sweep_.engine) != engines.end()) return;
  const std::string near = nearest_word(sweep_.engine, engines);
  refuse_option(fmt::format("--engine is '{}'", sweep_.engine), fmt::format("allowed: {}", fmt::join(engines, ", ")),
                near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

int SweepCommand::run() {
  for (const auto& [texts, to] :
       {std::pair{&vary_, &sweep_.vary}, {&reference_, &sweep_.reference}, {&columns_, &sweep_.columns}})
    for (const std::string& text : *texts) to->push_back({text});
  check_engine();
  if (!sweep_.jobs_alone.empty()) {
    if (!run_.scene.empty() || !vary_.empty())
      refuse_option("--job beside a scene or --vary",
                    "a job's folder says what it runs; --job HASH --out DIR is wanted", "leave out the rest");
    if (run_.out.empty()) refuse_option("--job without --out", "the folder of the sweep is wanted", "add --out DIR");
    return jobs_alone(run_.out, sweep_, quiet_);
  }
  if (run_.scene.empty())
    refuse_option("no SCENE", "a scene file, or a file with a [sweep] table, is wanted", "see impinge sweep --help");
  if (run_.out.empty()) run_.out = default_out(run_.scene, "-sweep");
  return sweep(sweep_, run_, quiet_);
}

}  // namespace

Entry<SubCommand> sweep_command() {
  return entry<SubCommand, SweepCommand>("sweep", "run a scene with many settings and put what came out side by side");
}

}  // namespace impinge
