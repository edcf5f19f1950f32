// A checkbox for each debug layer.
#include <fmt/format.h>

#include "viewer/layers/heat_map.hpp"
#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw_layers(Ui& ui, const DebugModel& model, CommandLines& lines) {
  ImGui::Columns(2, nullptr, false);
  for (const LayerSwitch& layer : model.view->layers) {
    bool on = layer.on;
    // ticked, and yet nothing of it is seen
    const std::string_view instead = on ? layer_instead_of(layer.name, *model.view) : "";
    if (!instead.empty()) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    if (ImGui::Checkbox(layer.name.c_str(), &on))
      lines.push_back(fmt::format("layer {}{}", on ? '+' : '-', layer.name));
    if (!instead.empty()) ImGui::PopStyleColor();
    ui.name("layers/" + layer.name);
    tooltip(instead.empty() ? layer.doc : fmt::format("{} Now {} colours the surfaces instead.", layer.doc, instead));
    ImGui::NextColumn();
  }
  ImGui::Columns(1);
}

}  // namespace

Panel layers_panel() { return {"layers", "layers", PanelPlace::left, {0.45f, 246.0f}, draw_layers}; }

}  // namespace impinge
