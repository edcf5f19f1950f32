#include "viewer/panels/panel_frame.hpp"

#include <fmt/format.h>

#include <cmath>

namespace impinge {

PanelFrame::PanelFrame(Ui& ui, const DebugModel& model, const char* name, const char* heading, const UiArea& area,
                       CommandLines& lines, float below) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (*heading != 0) {
    ImGui::TextColored({0.55f, 0.78f, 0.95f, 1.0f}, "%s", heading);
    ImGui::Separator();
  }
  ImGui::BeginChild("content", {0.0f, -below}, false, ImGuiWindowFlags_NoNav);
  const auto it = model.state.scroll.find(name);
  const float wanted = it == model.state.scroll.end() ? 0.0f : it->second, now = ImGui::GetScrollY();
  if (std::abs(now - wanted) < 1.0f) return;
  const bool by_hand = ui.wheel() != 0.0f || ImGui::IsMouseDown(0) || ui.went_up(0) || !ui.wanted().empty();
  if (by_hand)
    lines.push_back(fmt::format("panel scroll {} {}", name, std::round(now)));
  else
    ImGui::SetScrollY(std::min(wanted, ImGui::GetScrollMaxY()));
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

void close_on_escape(const Ui& ui) {
  if (ui.key_pressed("escape")) ImGui::CloseCurrentPopup();
}

std::string counted(std::int64_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
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
  // below what it explains, or above where there is no room below
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), window = ImGui::GetIO().DisplaySize;
  const float gap = 0.3f * ImGui::GetFontSize(), wrap = ImGui::GetFontSize() * 28.0f;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap), border = ImGui::GetStyle().WindowPadding;
  const bool below = high.y + gap + size.y + 2.0f * border.y <= window.y;
  const float x = std::max(0.0f, std::min(low.x, window.x - size.x - 2.0f * border.x));
  ImGui::SetNextWindowPos({x, below ? high.y + gap : low.y - gap}, 0, {0.0f, below ? 0.0f : 1.0f});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(wrap);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace impinge
