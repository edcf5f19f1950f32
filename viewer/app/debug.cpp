// impinge debug
#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <memory>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/debug_doors.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/bundle/bundle.hpp"
#include "viewer/controller/interrupt.hpp"
#include "viewer/debugger/window_loop.hpp"
#include "viewer/present/window.hpp"

namespace impinge {
namespace {

namespace fs = std::filesystem;

/// A script may hold both: lines by frame (at, from, expect), and lines to be done one after another.
struct DebugScript {
  std::string name;
  bool has_timed = false;
  std::vector<std::string> timed, lines;  // as long as the file, with empty lines where the other has one
};

DebugScript read_script(const fs::path& path) {
  DebugScript script;
  if (path.empty()) return script;
  script.name = path.string();
  for (std::string& line : read_lines(path)) {
    const std::string bare = line.substr(0, line.find('#'));
    const std::vector<PlacedText> words = split_words({bare, &script.name, 1, 1});
    const bool timed =
        !words.empty() && (words[0].text == "at" || words[0].text == "from" || words[0].text == "expect");
    script.has_timed |= timed;
    script.timed.push_back(timed ? line : "");
    script.lines.push_back(words.empty() || timed ? "" : bare.substr(0, bare.find_last_not_of(" \t\r") + 1));
  }
  return script;
}

struct Source {
  fs::path scene, run_folder;
  std::shared_ptr<const UnpackedBundle> bundle = nullptr;
  std::string name = {};
};

/// What the command line says.
struct Given {
  fs::path scene, script, out, record;
  std::string against;
  std::vector<std::string> overrides;
  bool window = false, headless = false, quiet = false, answers = false;
  int width = 1280, height = 720;  // pixels
  int scale = 0;                   // of text; 0: by the height
  int memory = 256;                // megabytes
  DebugDoors doors;
};

void refuse_overrides(const Given& options, const char* with) {
  if (!options.overrides.empty())
    throw InputError(fmt::format(
        "command line: --set with {}; its settings are in its run.toml; leave --set out, or debug the scene", with));
}

Source source_of(const Given& options) {
  if (!is_folder(options.scene)) {
    if (!is_bundle(options.scene)) return {options.scene, {}};
    refuse_overrides(options, "a bundle");
    auto bundle = std::make_shared<const UnpackedBundle>(options.scene);
    return {bundle->folder() / "run.toml", bundle->folder(), bundle, options.scene.filename().string()};
  }
  for (const char* name : {"run.toml", "stats.csv"})
    if (!is_there(options.scene / name))
      throw InputError(
          fmt::format("{}: this folder is no run's, it has no {}; a scene file, or a folder that impinge run has "
                      "written is wanted; choose one",
                      options.scene.string(), name));
  refuse_overrides(options, "a finished run");
  return {options.scene / "run.toml", options.scene};
}

/// PATH=VALUE is the same scene with that setting; else it is another scene, or a run's folder.
AgainstSource against_of(const Given& options, const Source& source, const DebugScript& script) {
  if (options.against.empty()) return {};
  AgainstSource b{source.scene, options.overrides, script.has_timed ? options.script : "", options.against};
  if (options.against.find('=') != std::string::npos && !is_there(options.against)) {
    b.overrides.push_back(options.against);
    return b;
  }
  b = {options.against, {}, {}, options.against};
  if (is_folder(b.scene)) b.scene /= "run.toml";
  return b;
}

/// What a recording is to be played with.
std::string command_of(const Given& options) {
  std::string text = fmt::format("# impinge debug {}", shell_word(options.scene.string()));
  for (const std::string& set : options.overrides) text += " --set " + shell_word(set);
  text += fmt::format(" --size {}x{}", options.width, options.height);
  if (!options.against.empty()) text += " --against " + shell_word(options.against);
  if (options.scale > 0) text += fmt::format(" --scale {}", options.scale);
  if (options.memory != Given().memory) text += fmt::format(" --memory {}", options.memory);
  return text + fmt::format(" --script {}\n", shell_word(options.record.string()));
}

/// A recording may take the place of an older one, and of nothing else.
void check_recording(const Given& options) {
  const fs::path& path = options.record;
  if (path.empty()) return;
  check_utf8_name(absolute_path(path).string());
  std::error_code error;
  if (fs::equivalent(path, options.script, error))
    throw InputError(fmt::format("command line: --record is the script itself, {}; another file is wanted; choose one",
                                 path.string()));
  if (is_file(path) && fs::file_size(path, error) > 0 &&
      !read_file(path, std::uint64_t{1} << 30).starts_with("# impinge debug "))
    throw InputError(
        fmt::format("command line: --record is {}, which is there and no recording; a new file is wanted; choose "
                    "another or remove it",
                    path.string()));
  try {  // better now than when there is something to lose; what is there stays until then
    const fs::path trial = temporary_name(path);
    write_file(trial, "");
    fs::remove(trial, error);
    if (is_folder(path)) throw OutputError(path.string(), "Is a directory");
  } catch (const OutputError& error) {
    throw InputError(
        fmt::format("command line: --record is {}, which can't be written ({}); a file in a folder that may be written "
                    "to is wanted; choose another",
                    path.string(), error.reason));
  }
}

void check_screen(const Given& options, bool windowed, int scale) {
  if (options.window && options.headless)
    refuse_option("--window and --headless", "one of them is allowed", "leave one out");
  if (options.doors.any() && options.headless)
    refuse_option("--web or --vnc with --headless", "one of them is allowed", "leave one out");
  options.doors.check();
  if (!windowed && !options.doors.any() && options.script.empty())
    throw InputError(
        "command line: debug without a screen and without --script; one of them is wanted; set DISPLAY, or write "
        "--web PORT for a browser, or --script FILE");
  if (options.window && !has_screen())
    throw InputError(
        "command line: --window without a screen; one is wanted; set DISPLAY, or use --headless with --script");
  if (options.width < scale * kLeastWidth || options.height < scale * kLeastHeight)
    throw InputError(fmt::format(
        "command line: --size is {}x{}; the panels want {}x{} at least with text of scale {}; choose a larger one{}",
        options.width, options.height, scale * kLeastWidth, scale * kLeastHeight, scale,
        scale > 1 ? ", or a smaller --scale" : ""));
}

std::unique_ptr<DebugWindow> make_window(const Given& options, int scale) {
  try {
    return std::make_unique<DebugWindow>(options.width, options.height, scale);
  } catch (const InternalError& error) {
    throw InputError(fmt::format("window of {}x{}: {}; a smaller one is wanted; change --size", options.width,
                                 options.height, error.what()));
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("window: {}; OpenGL through OSMesa is wanted; install libosmesa6", error.what()));
  }
}

/// What was answered, and what went wrong on the way.
void say_answers(const std::vector<ConsoleLine>& console, const Given& options) {
  for (const ConsoleLine& line : console)
    if (line.kind == ConsoleLine::message && options.answers && !options.quiet) fmt::print("{}\n", line.text);
  for (const ConsoleLine& line : console)
    if (line.kind == ConsoleLine::problem) fmt::print(stderr, "{}\n", line.text);
}

/// Where it stands, what B came to, what was answered, and what went wrong on the way.
void say_end(Debugger& debugger, const Given& options) {
  const DebugModel& model = debugger.model();
  if (!options.quiet) {
    fmt::print("frame {}, state {}{}\n", model.frame, hex64(debugger.state_hash()),
               model.stages != nullptr ? "; in the middle of it: " + model.stages->words(model.place) : "");
    if (model.against != nullptr) fmt::print("{}\n", model.against->words());
  }
  say_answers(model.console, options);
}

int debug(const Given& options) {
  const bool windowed = options.window || (!options.headless && !options.doors.any() && has_screen());
  const int scale = options.scale > 0 ? options.scale : debug_scale(options.height);
  check_screen(options, windowed, scale);
  const Source source = source_of(options);
  const DebugScript script = read_script(options.script);
  if (!source.run_folder.empty() && script.has_timed)
    throw InputError(
        fmt::format("{}: lines by frame (at, from, expect) with a finished run, which has its own; lines done "
                    "one after another are wanted; debug the scene instead",
                    script.name));
  check_recording(options);

  const std::unique_ptr<DebugWindow> window = make_window(options, scale);
  DebuggerOptions debugged;
  debugged.session.height = options.height;
  // what the camera is fitted to is the view
  debugged.session.width = static_cast<int>(options.height * window->view_aspect());
  if (script.has_timed) debugged.session.script_lines = script.timed;
  debugged.most_bytes = static_cast<std::size_t>(options.memory) << 20;
  debugged.run_folder = source.run_folder;
  debugged.name = source.name;
  debugged.against = against_of(options, source, script);
  debugged.interrupted = &interrupted();
  explain_interrupt("going back to the last whole frame and ending, within 2 s");
  FrameProgress progress;
  if (!options.quiet && isatty(STDERR_FILENO))
    debugged.progress = [&](int frame, int last) {
      if (frame < last)
        progress.show(frame, last);
      else
        progress.clear();
    };
  // without: a finished run's own
  Debugger debugger(source.scene, options.overrides, script.has_timed ? options.script : "", debugged);
  DebugLoop loop(debugger, *window, options.out);
  if (source.bundle) debugger.open_at(source.bundle->head(), source.bundle->lines("opening.script"));

  std::string saved;
  const auto save_recording = [&] {
    if (options.record.empty()) return;
    std::string text = command_of(options);
    for (const std::string& line : script.timed)
      if (!line.empty()) text += line + "\n";
    for (const std::string& line : debugger.recording(loop.pointer())) text += line + "\n";
    if (text != saved) write_file(options.record, text);
    saved = std::move(text);
  };
  const auto line_at = [&](std::size_t i) -> PlacedText {
    const std::size_t first = script.lines[i].find_first_not_of(" \t");
    return {std::string_view(script.lines[i]).substr(first), &script.name, static_cast<int>(i) + 1,
            static_cast<int>(first) + 1};
  };
  for (std::size_t i = 0; i < script.lines.size(); ++i)
    if (!script.lines[i].empty()) debugger.check(line_at(i));
  const std::string title = "impinge " + (source.name.empty() ? source.scene.filename().string() : source.name);
  std::vector<std::unique_ptr<Screen>> screens;
  if (options.doors.any()) screens = options.doors.open(options.width, options.height, title);
  try {
    for (std::size_t i = 0; i < script.lines.size() && !loop.has_quit() && !interrupted(); ++i)
      if (!script.lines[i].empty()) loop.run_line(line_at(i));
    if (windowed && !loop.has_quit() && !interrupted())
      screens.push_back(std::make_unique<Window>(options.width, options.height, title));
    if (!screens.empty() && !loop.has_quit() && !interrupted())
      show_on_screens(loop, *window, screens, interrupted(), save_recording);
  } catch (const Interrupted&) {  // while a frame was drawn or brought back
  } catch (...) {
    // what was done and answered before is kept
    if (!debugger.recording(loop.pointer()).empty()) save_recording();
    say_answers(debugger.model().console, options);
    throw;
  }
  save_recording();
  if (!interrupted()) debugger.tell_unchecked();
  say_end(debugger, options);
  if (interrupted()) return 130;
  return debugger.failures() > 0 ? 1 : 0;
}

class DebugCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("SCENE", given_.scene,
                 "scene file (TOML); or the folder of a run, which is shown without being simulated again where it has "
                 "kept the frame's state; or a bundle, at the moment that it holds");
    script_option(options, given_.script,
                  "script file: lines by frame as for run, and lines done one after another (viewer/README.md)");
    options.path("--record", given_.record, "file that gets what was done, as lines of a script that do it again");
    options.flag("--window", given_.window,
                 "show a window, after the script if there is one (default where there is a screen)");
    options.flag("--headless", given_.headless, "no window: the script drives it");
    options.flag("--answers", given_.answers, "print what find, why and the like answered, at the end");
    given_.doors.declare(options);
    options.text("--against", given_.against,
                 "PATH=VALUE: the same scene with that setting, or another scene or run's folder, made beside "
                 "this one; where they part is told, and its bodies are seen through");
    options.path("--out", given_.out, "folder that `shot FILE` lines write into (default: here)");
    size_option(options, given_.width, given_.height, "WIDTHxHEIGHT of the window in pixels (default: 1280x720)");
    options.whole("--scale", given_.scale, 1, 8, "size of text, in whole steps (default: by the height)");
    options.whole("--memory", given_.memory, 1, 1 << 20, "megabytes of states kept for going back (default: 256)");
    set_option(options, given_.overrides, "PATH=VALUE: override a parameter of the scene (repeatable)");
    quiet_option(options, given_.quiet, "say nothing but problems");
    memory_option(options);
    threads_option(options);
  }
  int run() override { return debug(given_); }

 private:
  Given given_;
};

}  // namespace

Entry<SubCommand> debug_command() {
  return entry<SubCommand, DebugCommand>(
      "debug", "the interactive debugger: play, step, go back, pick and change; what is done by hand is a script");
}

}  // namespace impinge
