// The debugger's panels, as a list. Each shows a part of the model and answers with command lines; none changes anything
// itself. A panel is a file that defines `Panel my_panel()`, and its line in all.cpp.
#pragma once

#include <string_view>

#include "viewer/panels/debug/ui.hpp"
#include "viewer/state/debug_model.hpp"

namespace impinge {

using CommandLines = std::vector<std::string>;

/// Beside the view: in the column on its left or right, from top to bottom. Under it: in a bar as wide as the window, or
/// below that, from left to right. In each place the panels stand in the order of the list.
enum class PanelPlace { left, right, bar, below };

/// How much of its place a panel takes: of a column's height, or, below, of the window's width.
struct PanelRoom {
  float share = 0.0f;  ///< 0: what the others leave; of the bar none has one
  float most = 0.0f;   ///< pixels where text has 13; 0: no bound; of the bar its height
};

struct Panel {
  std::string_view name;     ///< its widgets are NAME/WHAT; `panel scroll NAME PIXELS`
  std::string_view heading;  ///< "" for none
  PanelPlace place;
  PanelRoom room;
  /// Its content, which scrolls where it needs more room than there is.
  void (*draw)(Ui& ui, const DebugModel& model, CommandLines& lines);
  /// What the heading says after its words; nullptr: nothing.
  std::string (*count)(const DebugModel& model) = nullptr;
  /// A line of widgets under the content that doesn't scroll with it; nullptr: none.
  void (*draw_footer)(Ui& ui, const DebugModel& model, CommandLines& lines) = nullptr;
  /// The panel, before it in the list, in whose room it stands: one of them is seen, their headings are tabs. "": none.
  std::string_view shares = {};
  /// Whether a table in it scrolls, and not all of it.
  bool scrolls_inside = false;
};

/// All of them, in the order of drawing.
const std::vector<Panel>& panels();
std::vector<std::string> panel_names();

/// Whether it is the one that is seen in its room.
bool is_in_front(const Panel& panel, const PanelState& state);
/// The panel whose room it is: itself, or the one it shares that of.
std::string_view room_of(const Panel& panel);

/// Keeps the scroll position of the present window of Dear ImGui at what the model has for the panel; scrolled by hand
/// it comes out as a line.
void take_scroll(const std::string& panel, const Ui& ui, const DebugModel& model, CommandLines& lines);

/// Draws the panel there. Its scroll position is the model's; scrolled by hand it comes out as a line.
void draw_panel(const Panel& panel, const UiArea& area, Ui& ui, const DebugModel& model, CommandLines& lines);

}  // namespace impinge
