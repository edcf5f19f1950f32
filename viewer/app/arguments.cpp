#include "viewer/app/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <map>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

const std::vector<std::string> kBuilt = {"run",  "replay", "diff", "check",   "info", "list",
                                         "step", "sweep",  "test", "compare", "debug"};
const std::vector<std::string> kReserved = {"verify"};
const std::map<std::string, std::vector<std::string>> kReservedOptions = {{"debug", {"--vnc"}}};

[[noreturn]] void refuse(const std::string& found, const std::string& allowed, const std::string& remedy) {
  throw InputError(fmt::format("command line: {}; {}; {}", found, allowed, remedy));
}

int whole(std::string_view text, const char* what, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    refuse(fmt::format("{} is '{}'", what, text), fmt::format("a whole number from {} to {} is wanted", low, high),
           "change it");
  return value;
}

// before the parser sees them: words that are promised for later get a message of their own
void refuse_reserved(const std::vector<std::string>& words) {
  if (words.empty()) return;
  const std::string& command = words[0];
  if (std::find(kReserved.begin(), kReserved.end(), command) != kReserved.end())
    refuse(fmt::format("'{}' is not part of this version", command),
           fmt::format("allowed: {}", fmt::join(kBuilt, ", ")), "use one of them");
  if (command[0] != '-' && std::find(kBuilt.begin(), kBuilt.end(), command) == kBuilt.end()) {
    std::vector<std::string> all = kBuilt;
    all.insert(all.end(), kReserved.begin(), kReserved.end());
    const std::string near = nearest_word(command, all);
    refuse(fmt::format("unknown sub-command '{}'", command), fmt::format("allowed: {}", fmt::join(kBuilt, ", ")),
           near.empty() ? "see impinge --help" : fmt::format("did you mean '{}'?", near));
  }
  const auto it = kReservedOptions.find(command);
  if (it == kReservedOptions.end()) return;
  for (const std::string& word : words)
    for (const std::string& option : it->second)
      if (word == option || word.rfind(option + "=", 0) == 0)
        refuse(fmt::format("'{}' is not part of this version", option), fmt::format("see impinge {} --help", command),
               "leave it out");
}

// the parser's complaint on one line; for an option that isn't there, the nearest that is
std::string complaint(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  const CLI::App* command = &app;
  for (const CLI::App* sub : app.get_subcommands()) command = sub;
  std::vector<std::string> options;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (word.rfind("--", 0) != 0 || std::find(options.begin(), options.end(), name) != options.end()) continue;
    if (const std::string near = nearest_word(name, options); !near.empty())
      return fmt::format("command line: unknown option '{}'; options of this command are wanted; did you mean '{}'?",
                         name, near);
  }
  return fmt::format("command line: {}; see impinge{} --help for what is allowed; mend the line", text,
                     command == &app ? "" : " " + command->get_name());
}

double real(const std::string& text, const char* what, double low, double high) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    refuse(fmt::format("{} is '{}'", what, text), fmt::format("a number from {} to {} is wanted", low, high),
           "change it");
  return value;
}

std::vector<std::string> words_between_commas(const std::string& text, const char* what) {
  std::vector<std::string> list;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end == begin)
      refuse(fmt::format("{} is '{}'", what, text), "names with commas between them are wanted",
             "write them without gaps");
    list.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return list;
}

struct Raw {
  std::string scale, memory, response, lcp, step_tolerance, max_iterations, freeze;
  std::string size, frames, snapshots, threads, tolerance, export_format;
  std::string scene, script, out, jobs, repeat, filter, window, job;
  std::vector<std::string> vary, reference, columns;
  bool no_images = false;
};

void take_raw(const Raw& raw, Arguments& arguments) {
  RunOptions& options = arguments.run_options;
  options.scene = raw.scene;
  options.script = raw.script;
  options.out = raw.out;
  options.images = !raw.no_images;
  if (!raw.frames.empty()) options.frames = whole(raw.frames, "--frames", 0, 100'000'000);
  if (!raw.snapshots.empty())
    options.snapshot_megabytes = static_cast<std::uint64_t>(whole(raw.snapshots, "--snapshots", 0, 1 << 20));
  if (!raw.jobs.empty()) arguments.sweep_options.jobs = whole(raw.jobs, "--jobs", 1, 4096);
  if (!raw.repeat.empty()) arguments.sweep_options.repeat = whole(raw.repeat, "--repeat", 1, 1000);
  if (!raw.threads.empty()) arguments.threads = whole(raw.threads, "--threads", 1, 4096);
  if (!raw.tolerance.empty()) arguments.tolerance = whole(raw.tolerance, "--tolerance", 0, 255);
  if (!raw.freeze.empty()) options.freeze = whole(raw.freeze, "--freeze", 0, 100'000'000);
  if (!raw.response.empty()) arguments.responses = words_between_commas(raw.response, "--response");
  if (!raw.lcp.empty()) arguments.lcp = words_between_commas(raw.lcp, "--lcp");
  if (!raw.step_tolerance.empty()) arguments.step_tolerance = real(raw.step_tolerance, "--tolerance", 1e-16, 1.0);
  if (!raw.max_iterations.empty())
    arguments.max_iterations = whole(raw.max_iterations, "--max-iterations", 1, 100'000'000);
  if (!raw.scale.empty()) arguments.scale = whole(raw.scale, "--scale", 1, 8);
  if (!raw.memory.empty()) arguments.memory = whole(raw.memory, "--memory", 1, 1 << 20);
  if (arguments.window && arguments.headless)
    refuse("--window and --headless", "one of them is allowed", "leave one out");
  if (!raw.export_format.empty()) {
    if (raw.export_format != "ply")
      refuse(fmt::format("--export is '{}'", raw.export_format), "ply is wanted", "write --export ply");
    options.export_ply = true;
  }
  if (!raw.size.empty()) {
    const std::size_t x = raw.size.find('x');
    if (x == std::string::npos)
      refuse(fmt::format("--size is '{}'", raw.size), "WIDTHxHEIGHT is wanted", "write --size 1280x720");
    options.width = whole(std::string_view(raw.size).substr(0, x), "the width in --size", 16, 8192);
    options.height = whole(std::string_view(raw.size).substr(x + 1), "the height in --size", 16, 8192);
  }
  if (!arguments.video.empty() && !options.images)
    refuse("--video in a run without pictures", "pictures are wanted", "leave out --no-images");
}

void check_sweep(Raw& raw, Arguments& arguments) {
  SweepOptions& sweep = arguments.sweep_options;
  for (const std::string& text : raw.vary) sweep.vary.push_back({text});
  for (const std::string& text : raw.reference) sweep.reference.push_back({text});
  for (const std::string& text : raw.columns) sweep.columns.push_back({text});
  sweep.filter.text = raw.filter;
  sweep.window.text = raw.window;
  sweep.size_given = !raw.size.empty();
  const std::vector<std::string> engines = {"local", "list", "slurm"};
  if (std::find(engines.begin(), engines.end(), sweep.engine) == engines.end()) {
    const std::string near = nearest_word(sweep.engine, engines);
    refuse(fmt::format("--engine is '{}'", sweep.engine), fmt::format("allowed: {}", fmt::join(engines, ", ")),
           near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
  }
  if (!raw.job.empty()) {
    if (!raw.scene.empty() || !sweep.vary.empty())
      refuse("--job beside a scene or --vary", "a job's folder says what it runs; --job HASH --out DIR is wanted",
             "leave out the rest");
    if (raw.out.empty()) refuse("--job without --out", "the folder of the sweep is wanted", "add --out DIR");
    sweep.jobs_alone = words_between_commas(raw.job, "--job");
    return;
  }
  if (raw.scene.empty())
    refuse("no SCENE", "a scene file, or a file with a [sweep] table, is wanted", "see impinge sweep --help");
  if (raw.out.empty()) raw.out = "out/" + std::filesystem::path(raw.scene).stem().string() + "-sweep";
}

}  // namespace

Arguments parse_arguments(int count, const char* const* words) {
  const std::vector<std::string> list(words + std::min(count, 1), words + count);
  refuse_reserved(list);
  Arguments arguments;
  Raw raw;
  CLI::App app("impinge: collisions of bodies, simulated and shown");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("impinge ") + IMPINGE_VERSION);

  const auto scene_of = [&](CLI::App* command) {
    command->add_option("SCENE", raw.scene, "scene file (TOML), or the run.toml of a run")->required();
    command
        ->add_option("--set", arguments.run_options.overrides,
                     "PATH=VALUE: a parameter or a body's key, instead of the scene's")
        ->take_all()
        ->allow_extra_args(false);
  };
  const auto threads_of = [&](CLI::App* command) {
    command->add_option("--threads", raw.threads, "threads to use (default: all cores); changes no result");
  };

  CLI::App* run = app.add_subcommand("run", "simulate a scene and write its frames and figures into a folder");
  scene_of(run);
  run->add_option("--script", raw.script, "script file: commands by frame, and expectations");
  run->add_option("--out", raw.out, "folder to write to (default: out/SCENE)");
  run->add_option("--frames", raw.frames,
                  "the last frame's number (default: 240, or the script's last if that is later)");
  run->add_option("--size", raw.size, "WIDTHxHEIGHT of the pictures (default: 1280x720)");
  run->add_flag("--no-images", raw.no_images, "no pictures, figures only");
  run->add_option("--export", raw.export_format, "ply: the bodies' surfaces of each frame");
  run->add_flag("--contacts", arguments.run_options.contacts, "write contacts.csv");
  run->add_flag("--ids", arguments.run_options.ids,
                "write ids/NNNNNN.png too: what each pixel of a frame shows, for impinge diff to name what changed");
  run->add_option("--snapshots", raw.snapshots,
                  "megabytes for the states of the frames (default: 256): from these a run is resumed, and opened in "
                  "the debugger without being simulated again; "
                  "where they don't fit every second one is given up, and so on");
  run->add_flag("--judge", arguments.run_options.judge,
                "measure overlap independently of detection (slow): judged_penetration_m, judged_intersections");
  run->add_option("--freeze", raw.freeze,
                  "a frame whose last sub-step is written to frozen/NNNNNN.step before its response, for impinge step");
  threads_of(run);
  run->add_flag("--resume", arguments.run_options.resume, "continue an interrupted run in the folder");
  run->add_option("--video", arguments.video, "video file to make of the pictures (needs ffmpeg)");
  run->add_flag("--quiet", arguments.quiet, "say nothing but errors");

  CLI::App* replay = app.add_subcommand("replay", "repeat a recorded run and check every state hash");
  replay->add_option("DIR", arguments.a, "folder of the run")->required();
  threads_of(replay);

  CLI::App* diff = app.add_subcommand("diff", "compare two pictures or two folders of pictures");
  diff->add_option("A", arguments.a, "PNG file or folder: what is wanted")->required();
  diff->add_option("B", arguments.b, "PNG file or folder: what there is")->required();
  diff->add_option("--out", arguments.out, "folder for report.html and three-panel pictures of the differences");
  diff->add_option("--tolerance", raw.tolerance,
                   "largest difference of a channel, of 255, that counts as equal (default: 3)");
  diff->add_option("--mask", arguments.mask, "PNG: black pixels are not compared");
  diff->add_flag("--update", arguments.update,
                 "make A what B is where they differ beyond the limits, and say what was rewritten");

  CLI::App* check = app.add_subcommand("check", "check a scene (and a script) and do nothing else");
  scene_of(check);
  check->add_option("--script", raw.script, "script file");

  CLI::App* info = app.add_subcommand("info", "what of a scene is modelled and what is left out");
  scene_of(info);
  info->add_option("--script", raw.script, "script file");
  info->add_flag(
      "--ablation", arguments.ablation,
      "run the scene as it is and with each economy switched off: what it would cost, and what it would change");
  info->add_option("--frames", raw.frames, "with --ablation: the last frame's number (default: 20)");
  info->add_option("--out", arguments.out,
                   "with --ablation: folder for ablation.csv; a sweep's folder shows it in its report");
  info->add_option("--threads", raw.threads, "threads to use (default: all cores; one with --ablation)");

  CLI::App* names = app.add_subcommand("list", "parameters, layers and algorithms there are");
  names->add_option("TOPIC", arguments.a, fmt::format("{}", fmt::join(list_topics(), "|")))->required();

  CLI::App* step = app.add_subcommand(
      "step", "solve a frozen step or a published friction-contact problem with every method, and compare them");
  step->add_option("FILE", arguments.a,
                   "frozen step of impinge run --freeze, or a problem as Siconos writes it in plain text (W, q, mu)")
      ->required();
  step->add_option(
      "--response", raw.response,
      "of a frozen step: responses to run, with commas between them (default: all; see impinge list responses)");
  step->add_option("--lcp", raw.lcp,
                   "solvers to run, with commas between them (default: all that apply; see impinge list lcp_solvers)");
  step->add_option(
      "--tolerance", raw.step_tolerance,
      "relative residual to reach: of a frozen step the natural map, of a published problem Siconos' (default: 1e-8)");
  step->add_option("--max-iterations", raw.max_iterations, "iterations at most (default: 2000)");
  step->add_option(
      "--out", arguments.out,
      "folder for methods.csv, solution_METHOD.csv, history_METHOD.csv, work_precision.csv and their plots");

  CLI::App* test = app.add_subcommand(
      "test",
      "run every scene of a folder that has a script of the same name, and check its expectations and pictures");
  test->add_option("DIR", arguments.a,
                   "folder of NAME.toml and NAME.script; pictures as the scripts' `expect image` lines name them")
      ->required();
  test->add_option("--junit", arguments.junit, "XML file of the outcome, as continuous integration reads it");
  test->add_option("--out", arguments.out, "folder for the runs and the reports of failures (default: out/DIR-test)");
  test->add_option("--size", raw.size, "WIDTHxHEIGHT of pictures without a baseline yet (default: 320x180)");
  test->add_flag("--update", arguments.update,
                 "write the pictures that `expect image` lines name where they differ or are missing, and say which");
  threads_of(test);

  CLI::App* compare =
      app.add_subcommand("compare", "two runs: what was set differently, and in which frame, body and field they part");
  compare->add_option("A", arguments.a, "folder of a run")->required();
  compare->add_option("B", arguments.b, "folder of a run")->required();
  compare->add_option("--out", arguments.out,
                      "folder for difference.csv, its plot, and frames of A and B side by side");
  compare->add_option("--tolerance", raw.tolerance,
                      "of pictures: largest difference of a channel, of 255, that counts as equal (default: 3)");
  threads_of(compare);

  CLI::App* debug = app.add_subcommand(
      "debug", "the interactive debugger: play, step, go back, pick and change; what is done by hand is a script");
  debug
      ->add_option("SCENE", raw.scene,
                   "scene file (TOML), or the folder of a run, which is shown without being simulated again where it "
                   "has kept the frame's state")
      ->required();
  debug->add_option("--script", raw.script,
                    "script file: lines by frame as for run, and lines done one after another (viewer/README.md)");
  debug->add_option("--record", arguments.record,
                    "file that gets what was done, as lines of a script that do it again");
  debug->add_flag("--window", arguments.window,
                  "show a window, after the script if there is one (default where there is a screen)");
  debug->add_flag("--headless", arguments.headless, "no window: the script drives it");
  debug->add_option("--out", raw.out, "folder that `shot FILE` lines write into (default: here)");
  debug->add_option("--size", raw.size, "WIDTHxHEIGHT of the window in pixels (default: 1280x720)");
  debug->add_option("--scale", raw.scale, "size of text, in steps of 13 pixels (default: by the height)");
  debug->add_option("--memory", raw.memory, "megabytes of states kept for going back (default: 256)");
  debug
      ->add_option("--set", arguments.run_options.overrides,
                   "PATH=VALUE: override a parameter of the scene (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  debug->add_flag("--quiet", arguments.quiet, "say nothing but problems");
  threads_of(debug);

  CLI::App* sweep = app.add_subcommand("sweep", "run a scene with many settings and put what came out side by side");
  const auto words_of = [&](const char* name, std::vector<std::string>& to, const char* doc) {
    sweep->add_option(name, to, doc)->take_all()->allow_extra_args(false);
  };
  sweep->add_option("SCENE", raw.scene,
                    "scene file (TOML), or the run.toml of a run, or a file with a [sweep] table that says the rest");
  words_of("--set", arguments.run_options.overrides, "PATH=VALUE: the same in every job");
  words_of("--vary", raw.vary,
           "PATH=a,b,c or PATH=lo:hi:n or PATH=log(lo,hi,n): a job for each value, and for each combination of several "
           "--vary");
  sweep->add_flag("--zip", arguments.sweep_options.zip,
                  "the first values of all --vary together, then the second ones, ..., instead of all combinations");
  sweep->add_option("--filter", raw.filter,
                    "EXPR: only combinations for which it holds, such as 'simulation.substeps <= 8 || response.method "
                    "== \"penalty\"'");
  words_of("--reference", raw.reference,
           "PATH=VALUE: each job's errors are against the same job with these settings; or 'finest': with the sweep's "
           "smallest time step; or 'case:NAME': against a formula (see impinge list cases)");
  sweep->add_option("--window", raw.window,
                    "seconds that errors are taken over; 'all'; or 'automatic' (default): as long as a reference run "
                    "started 1e-9 scene sizes aside stays within 1e-3 of it");
  words_of("--column", raw.columns,
           "NAME=EXPR: one more column, over last(), max(), min(), mean(), sum() of a column of stats.csv and over "
           "varied paths");
  sweep->add_option(
      "--repeat", raw.repeat,
      "runs of each job: columns of times are then medians, with columns spread_..._ms (largest less smallest)");
  sweep->add_flag("--coarse-first", arguments.sweep_options.coarse_first,
                  "run the ends and middles of all ranges first; changes no result");
  sweep->add_option("--script", raw.script, "script file: commands by frame, and expectations");
  sweep->add_option("--frames", raw.frames,
                    "the last frame's number (default: 240, or the script's last if that is later)");
  sweep->add_option("--size", raw.size, "WIDTHxHEIGHT of the pictures (default: 1280x720)");
  sweep->add_flag("--no-images", raw.no_images, "no pictures, figures only");
  sweep->add_option("--jobs", raw.jobs,
                    "jobs at once, each in a process and on a thread of its own (default: all cores; with slurm: as "
                    "many as it gives)");
  sweep->add_option("--engine", arguments.sweep_options.engine,
                    "local: run here (default); list: print a command a job, for GNU parallel or a render farm; slurm: "
                    "submit a job array, wait and collect");
  sweep->add_option("--job", raw.job, "HASH[,HASH...]: run only these jobs of the sweep in --out");
  sweep->add_option("--out", raw.out, "folder to write to (default: out/SCENE-sweep)");
  sweep->add_flag(
      "--resume", arguments.run_options.resume,
      "take a folder that holds another sweep too, and keep the jobs that both have (the same sweep always goes on)");
  sweep->add_flag("--yes", arguments.sweep_options.yes, "more than 10000 jobs are meant");
  sweep->add_flag("--quiet", arguments.quiet, "say nothing but errors");

  try {
    app.parse(count, words);
  } catch (const CLI::CallForHelp&) {
    const CLI::App* command = &app;
    for (const CLI::App* sub : app.get_subcommands()) command = sub;
    arguments.text = command->help();
    return arguments;
  } catch (const CLI::CallForVersion& version) {
    arguments.text = std::string(version.what()) + "\n";
    return arguments;
  } catch (const CLI::ParseError& error) {
    throw InputError(complaint(app, error, list));
  }
  const std::string command = app.get_subcommands().front()->get_name();
  arguments.kind = static_cast<Arguments::Kind>(std::find(kBuilt.begin(), kBuilt.end(), command) - kBuilt.begin());
  if (command == "run" && raw.out.empty()) raw.out = "out/" + std::filesystem::path(raw.scene).stem().string();
  if (command == "sweep") check_sweep(raw, arguments);
  if (command == "test" && raw.size.empty()) raw.size = "320x180";
  if (command == "info" && !arguments.ablation && (!raw.frames.empty() || !arguments.out.empty()))
    refuse(raw.frames.empty() ? "--out without --ablation" : "--frames without --ablation", "info alone runs nothing",
           "add --ablation, or leave it out");
  take_raw(raw, arguments);
  return arguments;
}

}  // namespace impinge
