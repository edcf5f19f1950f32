// A checkbox for each debug layer.
#include <fmt/format.h>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw_layers(Ui& ui, const DebugModel& model, CommandLines& lines) {
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

}  // namespace

Panel layers_panel() { return {"layers", "layers", PanelPlace::left, {0.45f, 246.0f}, draw_layers}; }

}  // namespace impinge
