// What was done, as the lines that do it again; and a place to write some.
#include "viewer/panels/debug/widgets.hpp"

namespace impinge {

namespace {

void draw_console(Ui&, const DebugModel& model, CommandLines&) {
  // newest last, and in sight
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float between = ImGui::GetTextLineHeightWithSpacing() - ImGui::GetTextLineHeight();
  const std::size_t n = model.console.size();
  std::size_t first = n;
  for (float left = room.y; first > 0; --first) {
    left -= ImGui::CalcTextSize(model.console[first - 1].text.c_str(), nullptr, false, room.x).y + between;
    if (left < -between && first < n) break;
  }
  ImGui::PushTextWrapPos(0.0f);
  for (std::size_t i = first; i < n; ++i) {
    const ConsoleLine& line = model.console[i];
    const ImVec4 ink = line.kind == ConsoleLine::problem   ? ImVec4(1.0f, 0.55f, 0.45f, 1.0f)
                       : line.kind == ConsoleLine::message ? dim()
                                                           : ImGui::GetStyleColorVec4(ImGuiCol_Text);
    ImGui::TextColored(ink, "%s", line.text.c_str());
  }
  ImGui::PopTextWrapPos();
}

void draw_command_line(Ui& ui, const DebugModel&, CommandLines& lines) {
  auto& text = ui.typing().line;
  ImGui::SetNextItemWidth(-1.0f);
  const bool entered = ImGui::InputTextWithHint("##line", "a command, e.g. set contact.friction 0.5", text.data(),
                                                text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ui.name("console/line");
  if (!entered) return;
  if (text[0] != 0) lines.emplace_back(text.data());
  text[0] = 0;
  ImGui::SetKeyboardFocusHere(-1);  // the next line follows
}

}  // namespace

Panel console_panel() {
  return {"console", "console", PanelPlace::below, {0.36f, 0.0f}, draw_console, nullptr, draw_command_line};
}

}  // namespace impinge
