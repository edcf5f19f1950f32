// The debugger's keys: what they do, and the list of them.
#pragma once

#include "viewer/panels/debug/panel.hpp"

namespace impinge {

/// What the keys do, as lines.
void keys_to_lines(const Ui& ui, const DebugModel& model, CommandLines& lines);
/// Over the view, while it is asked for.
void draw_help(const DebugModel& model, const UiArea& view);

}  // namespace impinge
