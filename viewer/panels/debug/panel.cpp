#include "viewer/panels/debug/panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

const ImVec4 kHeading = {0.55f, 0.78f, 0.95f, 1.0f};

/// The headings of all panels of the room; a click brings one to the front.
void draw_tabs(const std::string& heading, const Panel& seen, Ui& ui, CommandLines& lines) {
  bool is_first = true;
  for (const Panel& panel : panels()) {
    if (room_of(panel) != room_of(seen)) continue;
    if (!is_first) ImGui::SameLine(0.0f, 14.0f * ui.unit());
    is_first = false;
    const bool is_seen = panel.name == seen.name;
    ImGui::TextColored(is_seen ? kHeading : dim(), "%s", is_seen ? heading.c_str() : panel.heading.data());
    ui.name(fmt::format("panels/{}", panel.name));
    if (is_seen) continue;
    const bool asked = ui.wanted().starts_with(fmt::format("{}/", panel.name));
    if (ImGui::IsItemClicked() || asked) lines.push_back(fmt::format("panel front {}", panel.name));
  }
}

bool is_alone(const Panel& panel) {
  return std::count_if(panels().begin(), panels().end(),
                       [&](const Panel& other) { return room_of(other) == room_of(panel); }) == 1;
}

}  // namespace

std::string_view room_of(const Panel& panel) { return panel.shares.empty() ? panel.name : panel.shares; }

bool is_in_front(const Panel& panel, const PanelState& state) {
  const auto it = state.front.find(std::string(room_of(panel)));
  return panel.name == (it == state.front.end() ? room_of(panel) : std::string_view(it->second));
}

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
    if (is_alone(panel))
      ImGui::TextColored(kHeading, "%s", heading.c_str());
    else
      draw_tabs(heading, panel, ui, lines);
    ImGui::Separator();
  }
  const float below = panel.draw_footer == nullptr ? 0.0f : ImGui::GetFrameHeight() + 4.0f * ui.unit();
  ImGui::BeginChild("content", {0.0f, -below}, false, ImGuiWindowFlags_NoNav);
  if (!panel.scrolls_inside) take_scroll(name, ui, model, lines);
  panel.draw(ui, model, lines);
  ImGui::EndChild();
  if (panel.draw_footer != nullptr) panel.draw_footer(ui, model, lines);
  ImGui::End();
}

}  // namespace impinge
