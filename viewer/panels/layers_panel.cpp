// A checkbox for each debug layer.
#include <fmt/format.h>

#include "viewer/panels/panel_frame.hpp"

namespace impinge {

void draw_layers_panel(Ui& ui, const DebugModel& model, const UiArea& area, CommandLines& lines) {
  const PanelFrame frame(ui, model, "layers", "layers", area, lines);
  ImGui::Columns(2, nullptr, false);
  for (const LayerSwitch& layer : model.view->layers) {
    bool on = layer.on;
    if (ImGui::Checkbox(layer.name.c_str(), &on))
      lines.push_back(fmt::format("layer {}{}", on ? '+' : '-', layer.name));
    ui.name("layers/" + layer.name);
    tooltip(layer.doc);
    ImGui::NextColumn();
  }
  ImGui::Columns(1);
}

}  // namespace impinge
