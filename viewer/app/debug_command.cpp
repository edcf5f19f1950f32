// impinge debug
#include <fmt/format.h>

#include <cstdio>

#include "engine/core/error.hpp"
#include "engine/core/archive.hpp"
#include "engine/io/file.hpp"
#include "viewer/app/commands.hpp"
#include "viewer/app/sdl_window.hpp"

namespace impinge {
namespace {

namespace fs = std::filesystem;

/// A script may hold both: lines by frame (at, from, expect, break), and lines to be done one after another.
struct DebugScript {
  std::string name;
  std::vector<std::string> timed, lines;  // as long as the file, with empty lines where the other has one
};

DebugScript read_script(const fs::path& path) {
  DebugScript script;
  if (path.empty()) return script;
  script.name = path.string();
  for (std::string& line : read_lines(path)) {
    const std::string bare = line.substr(0, line.find('#'));
    const std::vector<PlacedText> words = split_words({bare, &script.name, 1, 1});
    const bool timed = !words.empty() && (words[0].text == "at" || words[0].text == "from" || words[0].text == "expect" || words[0].text == "break");
    script.timed.push_back(timed ? line : "");
    script.lines.push_back(words.empty() || timed ? "" : bare.substr(0, bare.find_last_not_of(" \t\r") + 1));
  }
  return script;
}

struct Source {
  fs::path scene, run_folder;
};

Source source_of(const RunOptions& options) {
  if (!fs::is_directory(options.scene)) return {options.scene, {}};
  if (!fs::exists(options.scene / "run.toml") || !fs::exists(options.scene / "stats.csv"))
    throw InputError(fmt::format("{}: this folder is no run's; a scene file, or a folder that impinge run has written is wanted; choose one", options.scene.string()));
  if (!options.overrides.empty()) throw InputError("command line: --set with a finished run; its settings are in its run.toml; leave --set out, or debug the scene");
  return {options.scene / "run.toml", options.scene};
}

}  // namespace

int debug_command(const Arguments& arguments) {
  const RunOptions& options = arguments.run_options;
  const bool windowed = arguments.window || (!arguments.headless && has_screen());
  if (!windowed && options.script.empty())
    throw InputError("command line: debug without a screen and without --script; one of them is wanted; set DISPLAY, or write --script FILE");
  const Source source = source_of(options);
  const DebugScript script = read_script(options.script);

  std::unique_ptr<DebugWindow> window;
  try {
    window = std::make_unique<DebugWindow>(options.width, options.height, arguments.scale);
  } catch (const InternalError& error) {
    throw InputError(fmt::format("window of {}x{}: {}; a smaller one is wanted; change --size", options.width, options.height, error.what()));
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("window: {}; OpenGL through OSMesa is wanted; install libosmesa6", error.what()));
  }
  DebuggerOptions debug;
  debug.session.height = options.height;
  debug.session.width = static_cast<int>(options.height * window->view_aspect());  // what the camera is fitted to is the view
  if (!script.timed.empty()) debug.session.script_lines = script.timed;
  debug.most_bytes = static_cast<std::size_t>(arguments.memory) << 20;
  debug.run_folder = source.run_folder;
  Debugger debugger(source.scene, options.overrides, options.script, debug);
  DebugLoop loop(debugger, *window, options.out);

  for (std::size_t i = 0; i < script.lines.size() && !loop.has_quit(); ++i)
    if (const std::string& line = script.lines[i]; !line.empty()) {
      const std::size_t first = line.find_first_not_of(" \t");
      loop.run_line({std::string_view(line).substr(first), &script.name, static_cast<int>(i) + 1, static_cast<int>(first) + 1});
    }
  if (windowed && !loop.has_quit()) show_window(loop, *window, "impinge " + source.scene.filename().string());

  if (!arguments.record.empty()) {
    std::string text;
    for (const std::string& line : debugger.recording(loop.pointer())) text += line + "\n";
    write_file(arguments.record, text);
  }
  if (!arguments.quiet) fmt::print("frame {}, state {}\n", debugger.model().frame, hex64(debugger.state_hash()));
  for (const ConsoleLine& line : debugger.model().console)
    if (line.kind == ConsoleLine::problem) fmt::print(stderr, "{}\n", line.text);
  return debugger.failures() > 0 ? 1 : 0;
}

}  // namespace impinge
