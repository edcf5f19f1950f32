#include "viewer/debugger/loop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/png.hpp"
#include "viewer/layers/view_text.hpp"
#include "viewer/panels/debug/series.hpp"

namespace impinge {
namespace {

constexpr int kLooks = 6;  // frames in which a widget may unfold and scroll into sight
int code_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

DebugLoop::DebugLoop(Debugger& debugger, DebugWindow& window, std::filesystem::path out)
    : debugger_(debugger), window_(window), out_(std::move(out)) {}

void DebugLoop::draw(bool quick) {
  fresh_ = false;
  CommandLines lines;
  {
    const PauseScope none(nullptr);  // a pause draws
    lines = window_.paint(debugger_.model(), quick);
  }
  for (const std::string& line : lines) obey(line);
}

void DebugLoop::obey(const std::string& line) {
  fresh_ = true;
  static const std::string kConsole = "console";
  const std::optional<DebugLine> rest = debugger_.try_execute(line);
  if (!rest) return;
  try {
    take(*rest, {line, &kConsole, 1, 1});
  } catch (const InputError& error) {
    debugger_.say(ConsoleLine::problem, error.what());
  }
}

bool DebugLoop::tick_meanwhile(double seconds) {
  DebugModel model = debugger_.model();
  model.computing = std::max(seconds, 1e-3);
  bool goes_on = true;
  for (const std::string& line : window_.paint(model, true)) {
    if (line == "stop")
      goes_on = false, waiting_.clear();  // what was asked for behind it is not wanted either
    else if (!debugger_.execute_meanwhile(line))
      waiting_.push_back(line);
  }
  fresh_ = true;  // drawn well again afterwards
  return goes_on;
}

void DebugLoop::tick() {
  for (const std::string& line : std::exchange(waiting_, {})) obey(line);
  draw(window_.ui().has_events());  // all that will be seen for long is drawn well
  try {
    if (debugger_.play_on()) fresh_ = true;
  } catch (const InputError& error) {  // settings that don't go together
    debugger_.say(ConsoleLine::problem, error.what());
    obey("pause");
  }
}

void DebugLoop::settle() {
  for (int k = 0; k < 3 || (is_busy() && k < 60); ++k) draw();  // what is laid out anew takes Dear ImGui two frames
}

Image DebugLoop::picture() {
  settle();
  Image image;
  window_.read(image);
  return image;
}

void DebugLoop::run_line(const PlacedText& line) {
  fresh_ = true;
  if (const std::optional<DebugLine> rest = debugger_.execute(line)) take(*rest, line);
}

void DebugLoop::take(const DebugLine& line, const PlacedText& place) {
  if (const auto* i = std::get_if<InputLine>(&line)) input(*i, place);
  if (const auto* file = std::get_if<FileLine>(&line)) {
    switch (file->what) {
      case FileLine::shot:
        shoot(file->file, place);
        break;
      case FileLine::plots:
        write_plots(file->file, place);
        break;
      case FileLine::bundle:
        write_bundle(file->file, place);
    }
  }
  if (const auto* frozen = std::get_if<FreezeLine>(&line)) freeze(frozen->file, place);
  if (const auto* frames = std::get_if<ExportLine>(&line)) export_frames(frames->format, frames->folder, place);
  if (std::holds_alternative<QuitLine>(line)) quit_ = true;
}

void DebugLoop::freeze(const std::string& file, const PlacedText& place) {
  const std::filesystem::path path = out_ / file;
  if (debugger_.model().frame == 0)
    place.refuse("freeze at frame 0, which no step made", "a later frame is wanted", "step on first");
  try {
    if (path.has_parent_path()) make_folder(path.parent_path());
    debugger_.freeze(path);
  } catch (const OutputError& error) {
    place.refuse(fmt::format("{} can't be written ({})", path.string(), error.reason),
                 "a folder that may be written to is wanted", "change --out or the name");
  }
  debugger_.record_freeze(file);
}

void DebugLoop::export_frames(const std::string& format, const std::string& folder, const PlacedText& place) {
  const std::filesystem::path path = out_ / folder;
  try {
    const std::string result = debugger_.export_frames(format, path);
    if (!result.empty()) debugger_.say(ConsoleLine::message, result);
  } catch (const OutputError& error) {
    place.refuse(fmt::format("{} can't be written ({})", path.string(), error.reason),
                 "a folder that may be written to is wanted", "change --out or the name");
  }
  debugger_.record_file(fmt::format("export {} {}", format, folder));
}

const UiWidget& DebugLoop::find(const std::string& name, const PlacedText& place) {
  Ui& ui = window_.ui();
  ui.look_for(name);
  for (int k = 0; k < kLooks; ++k) {
    draw();
    if (const UiWidget* widget = ui.find(name); widget != nullptr && widget->visible && k > 1) break;
  }
  ui.look_for("");
  const UiWidget* widget = ui.find(name);
  if (widget != nullptr) return *widget;
  const std::vector<std::string> names = ui.widget_names();
  const std::string near = nearest_word(name, names);
  place.refuse(
      fmt::format("no widget '{}'", name),
      fmt::format("there are {}, such as {}", names.size(),
                  fmt::join(names.begin(), names.begin() + std::min<std::ptrdiff_t>(6, std::ssize(names)), ", ")),
      near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

void DebugLoop::input(const InputLine& line, const PlacedText& place) {
  Ui& ui = window_.ui();
  const auto click = [&](float x, float y) {
    ui.add({UiEvent::move, x, y});
    ui.add({UiEvent::press});
    ui.add({UiEvent::release});
  };
  switch (line.verb) {
    case InputLine::click: {
      const UiArea area = find(line.name, place).area;
      click(std::round(area.x + 0.5f * area.width), std::round(area.y + 0.5f * area.height));
      break;
    }
    case InputLine::drag: {
      const UiWidget widget = find(line.name, place);
      if (!widget.is_slider)
        place.refuse(fmt::format("'{}' is no slider", line.name), "a slider is wanted", "use ui click");
      const double low = widget.logarithmic ? std::pow(10.0, widget.low) : widget.low,
                   high = widget.logarithmic ? std::pow(10.0, widget.high) : widget.high;
      if (line.x < low * (low > 0.0 ? 1.0 - 1e-9 : 1.0) || line.x > high * (1.0 + 1e-9))
        place.refuse(fmt::format("{:.6g} on the slider '{}'", line.x, line.name),
                     fmt::format("it goes from {:.6g} to {:.6g}", low, high),
                     "choose a value in between, or write set");
      click(std::round(ui.slider_x(widget, line.x)), std::round(widget.area.y + 0.5f * widget.area.height));
      break;
    }
    case InputLine::move:
      ui.add({UiEvent::move, static_cast<float>(line.x), static_cast<float>(line.y)});
      if (line.has_clicked) ui.add({UiEvent::clicked});
      break;
    case InputLine::press:
      ui.add({UiEvent::press, 0, 0, code_of(button_names(), line.name)});
      break;
    case InputLine::release:
      ui.add({UiEvent::release, 0, 0, code_of(button_names(), line.name)});
      break;
    case InputLine::wheel:
      ui.add({UiEvent::wheel, 0, static_cast<float>(line.y)});
      break;
    case InputLine::key:
      if (line.goes_down) ui.add({UiEvent::key_down, 0, 0, code_of(key_names(), line.name)});
      if (line.goes_up) ui.add({UiEvent::key_up, 0, 0, code_of(key_names(), line.name)});
      break;
    case InputLine::type:
      ui.add({UiEvent::type, 0, 0, 0, line.name});
      break;
    case InputLine::wait:
      for (int k = 0; k < static_cast<int>(line.x) && !debugger_.is_interrupted(); ++k) tick();
      return;
  }
  while (ui.has_events()) tick();
  tick();
}

void DebugLoop::write_plots(const std::string& file, const PlacedText& place) {
  const std::filesystem::path path = out_ / file;
  try {
    if (path.has_parent_path()) make_folder(path.parent_path());
    write_file(path, plots_csv(debugger_.model()));
  } catch (const OutputError& error) {
    place.refuse(fmt::format("{} can't be written ({})", path.string(), error.reason),
                 "a folder that may be written to is wanted", "change --out or the name");
  }
  debugger_.record_file("plots " + file);
}

PngText DebugLoop::picture_text() const {
  const DebugModel& model = debugger_.model();
  PngText text = {{"impinge:scene", debugger_.scene_file_name()},
                  {"impinge:frame", std::to_string(model.frame)},
                  {"impinge:state_hash", hex64(debugger_.state_hash())},
                  {"impinge:renderer", window_.renderer_name()},
                  {"impinge:view", view_text(*model.view)}};
  if (model.stages != nullptr) text.emplace_back("impinge:stage", model.stages->words(model.place));
  return text;
}

void DebugLoop::write_bundle(const std::string& file, const PlacedText& place) {
  const std::filesystem::path path = out_ / file;
  const std::string picture = encode_png(this->picture(), picture_text());
  auto [head, parts] = debugger_.bundle(pointer());
  parts["picture.png"] = picture;
  try {
    if (path.has_parent_path()) make_folder(path.parent_path());
    write_file(path, format_bundle(head, parts));
  } catch (const OutputError& error) {
    place.refuse(fmt::format("{} can't be written ({})", path.string(), error.reason),
                 "a folder that may be written to is wanted", "change --out or the name");
  }
  debugger_.record_bundle(file, pointer());
  debugger_.say(ConsoleLine::message,
                fmt::format("all of it is in {}, below --out; impinge debug opens it anywhere", file));
}

void DebugLoop::shoot(const std::string& file, const PlacedText& place) {
  const std::filesystem::path path = out_ / file;
  const Image image = picture();
  try {
    if (path.has_parent_path()) make_folder(path.parent_path());
    write_png(path, image, picture_text());
  } catch (const OutputError& error) {
    place.refuse(fmt::format("{} can't be written ({})", path.string(), error.reason),
                 "a folder that may be written to is wanted", "change --out or the name");
  }
  debugger_.record_shot(file, pointer());  // now: a picture doesn't show itself in the console
}

}  // namespace impinge
