// The debugger's panels. Each shows a part of the model and answers with command lines; none changes anything itself.
#pragma once

#include "viewer/panels/debug_model.hpp"
#include "viewer/panels/ui.hpp"

namespace impinge {

using CommandLines = std::vector<std::string>;

/// Where everything is: columns left and right, a strip below, the view between them. Nothing overlaps.
struct DebugLayout {
  UiArea view, layers, parameters, inspector, contacts, stages, transport, timeline, console;
};
DebugLayout debug_layout(int width, int height, float unit);
/// The smallest window that the panels have room in, for unit 1.
constexpr int kLeastWidth = 800, kLeastHeight = 500;

/// Of the plots in the timeline, which take turns; apart for colour-blind eyes too.
constexpr std::uint32_t kPlotInks[] = {0x56b4e9, 0xe69f00, 0x2fbf93, 0xf0e442, 0xcc79a7, 0xd9dee6};

/// Whole-number text scale for a window of that height.
int debug_scale(int height);

void draw_transport_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_layers_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_parameters_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_timeline_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_contacts_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_inspector_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_stages_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
void draw_console_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines);
/// Over the view, while it is asked for.
void draw_help_panel(Ui& ui, const DebugModel& model, const UiArea& view);

/// What the keys do, as lines.
void keys_to_lines(const Ui& ui, const DebugModel& model, CommandLines& lines);

}  // namespace impinge
