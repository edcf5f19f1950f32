// The debugger at work: lines of a script and frames of the window meet the controller here. With a screen or without
// one, the same.
#pragma once

#include <algorithm>

#include "viewer/debugger/debugger.hpp"
#include "viewer/present/debug_window.hpp"

namespace impinge {

class DebugLoop {
 public:
  /// `out`: the folder that shots are written into.
  DebugLoop(Debugger& debugger, DebugWindow& window, std::filesystem::path out);

  /// Does a script's line to its end. Throws InputError at its place, also for a widget that isn't there.
  void run_line(const PlacedText& line);
  /// One frame of the window: draws, does what was asked for, makes a frame of the scene while playing.
  void tick();
  /// The same while a tick computes, at a pause: the window looks at its input and draws. What would change the model
  /// waits for the next tick; `stop` is handed back as false. `seconds`: since the frame in work was begun.
  bool tick_meanwhile(double seconds);
  /// Whether the next tick may show something new.
  bool is_busy() const { return fresh_ || window_.is_rough() || window_.ui().has_events(); }
  /// How long the frame that was made in the last tick is to be seen: while playing as long as it lasts in the scene,
  /// else 0.
  double seconds_to_show() const {
    return std::min(debugger_.model().playing ? debugger_.model().record->frame_time : 0.0, 0.1);
  }
  bool has_quit() const { return quit_; }
  int frame() const { return debugger_.model().frame; }
  UiPointer pointer() const { return window_.ui().pointer(); }
  /// The window as it is once everything that was asked for shows.
  Image picture();

 private:
  void take(const DebugLine& line, const PlacedText& place);
  void input(const InputLine& line, const PlacedText& place);
  const UiWidget& find(const std::string& name, const PlacedText& place);
  void draw(bool quick = false);
  void obey(const std::string& line);
  void settle();
  void write_plots(const std::string& file, const PlacedText& place);
  PngText picture_text() const;
  void shoot(const std::string& file, const PlacedText& place);
  void write_bundle(const std::string& file, const PlacedText& place);
  void freeze(const std::string& file, const PlacedText& place);
  void export_frames(const std::string& format, const std::string& folder, const PlacedText& place);

  Debugger& debugger_;
  DebugWindow& window_;
  std::filesystem::path out_;
  bool fresh_ = true, quit_ = false;
  std::vector<std::string> waiting_;  // lines that came while something was computed
};

}  // namespace impinge
