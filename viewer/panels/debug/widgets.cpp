#include "viewer/panels/debug/widgets.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace impinge {

bool named_button(Ui& ui, const std::string& name, const char* label, bool lit) {
  if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
  const bool clicked = ImGui::Button(label);
  if (lit) ImGui::PopStyleColor();
  ui.name(name);
  return clicked;
}

std::optional<std::string> search_field(Ui& ui, const std::string& name, const std::string& now) {
  char words[64] = {};
  std::strncpy(words, now.c_str(), sizeof words - 1);
  ImGui::SetNextItemWidth(-1.0f);
  const bool is_changed = ImGui::InputTextWithHint(("##" + name).c_str(), "search", words, sizeof words);
  ui.name(name);
  return is_changed ? std::optional<std::string>(words) : std::nullopt;
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
  if (static_cast<const Ui*>(ImGui::GetIO().UserData)->pointer().has_clicked) return;
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
