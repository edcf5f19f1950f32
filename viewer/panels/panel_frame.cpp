#include "viewer/panels/panel_frame.hpp"

#include <fmt/format.h>

#include <cmath>

namespace impinge {

PanelFrame::PanelFrame(Ui& ui, const DebugModel& model, const char* name, const char* heading, const UiArea& area, CommandLines& lines, float below) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollbar |
                   ImGuiWindowFlags_NoScrollWithMouse);
  if (*heading != 0) {
    ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "%s", heading);
    ImGui::Separator();
  }
  ImGui::BeginChild("content", {0.0f, -below}, false, ImGuiWindowFlags_NoNav);
  const auto it = model.state.scroll.find(name);
  const float wanted = it == model.state.scroll.end() ? 0.0f : it->second, now = ImGui::GetScrollY();
  if (std::abs(now - wanted) < 1.0f) return;
  const bool by_hand = ui.wheel() != 0.0f || ImGui::IsMouseDown(0) || ui.went_up(0) || !ui.wanted().empty();
  if (by_hand) lines.push_back(fmt::format("panel scroll {} {}", name, std::round(now)));
  else ImGui::SetScrollY(std::min(wanted, ImGui::GetScrollMaxY()));
}

void PanelFrame::end_content() {
  ImGui::EndChild();
  in_content_ = false;
}

PanelFrame::~PanelFrame() {
  if (in_content_) ImGui::EndChild();
  ImGui::End();
}

bool named_button(Ui& ui, const std::string& name, const char* label, bool lit) {
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
  const bool clicked = ImGui::Button(label);
  if (lit) ImGui::PopStyleColor();
  ui.name(name);
  return clicked;
}

std::string brief(double v, int digits) {
  std::string text = fmt::format("{:.{}g}", v + 0.0, digits);  // no -0
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  std::size_t zeros = e + 2;
  while (zeros + 1 < text.size() && text[zeros] == '0') ++zeros;
  return text.substr(0, e + 1) + (text[e + 1] == '-' ? "-" : "") + text.substr(zeros);
}

void tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28.0f);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace impinge
