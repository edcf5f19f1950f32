#include "viewer/panels/debug/panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

namespace impinge {

namespace {

void take_scroll(const std::string& name, const Ui& ui, const DebugModel& model, CommandLines& lines) {
  const auto it = model.state.scroll.find(name);
  const float wanted = it == model.state.scroll.end() ? 0.0f : it->second, now = ImGui::GetScrollY();
  if (std::abs(now - wanted) < 1.0f) return;
  const bool by_hand = ui.wheel() != 0.0f || ImGui::IsMouseDown(0) || ui.went_up(0) || !ui.wanted().empty();
  if (by_hand)
    lines.push_back(fmt::format("panel scroll {} {}", name, std::round(now)));
  else
    ImGui::SetScrollY(std::min(wanted, ImGui::GetScrollMaxY()));
}

}  // namespace

std::vector<std::string> panel_names() {
  std::vector<std::string> names;
  for (const Panel& panel : panels()) names.emplace_back(panel.name);
  return names;
}

void draw_panel(const Panel& panel, const UiArea& area, Ui& ui, const DebugModel& model, CommandLines& lines) {
  const std::string name(panel.name);
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin(name.c_str(), nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (!panel.heading.empty()) {
    const std::string heading = std::string(panel.heading) + (panel.count == nullptr ? "" : panel.count(model));
    ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "%s", heading.c_str());
    ImGui::Separator();
  }
  const float below = panel.draw_footer == nullptr ? 0.0f : ImGui::GetFrameHeight() + 4.0f * ui.unit();
  ImGui::BeginChild("content", {0.0f, -below}, false, ImGuiWindowFlags_NoNav);
  take_scroll(name, ui, model, lines);
  panel.draw(ui, model, lines);
  ImGui::EndChild();
  if (panel.draw_footer != nullptr) panel.draw_footer(ui, model, lines);
  ImGui::End();
}

}  // namespace impinge
