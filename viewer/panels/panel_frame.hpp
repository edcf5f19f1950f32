// What all panels of the debugger are drawn in: a fixed sheet with a heading, its content scrolling below.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <string>

#include "viewer/draw/palette.hpp"
#include "viewer/panels/debug_panels.hpp"

namespace impinge {

/// Begins on construction, ends on destruction. The scroll position is the model's; scrolled by hand it comes out as a
/// line.
class PanelFrame {
 public:
  PanelFrame(Ui& ui, const DebugModel& model, const char* name, const char* heading, const UiArea& area,
             CommandLines& lines, float below = 0.0f);
  ~PanelFrame();
  PanelFrame(const PanelFrame&) = delete;
  PanelFrame& operator=(const PanelFrame&) = delete;

  /// Leaves the scrolling part; what follows stands below it, in the `below` pixels kept free.
  void end_content();

 private:
  bool in_content_ = true;
};

inline ImVec4 dim() { return ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled); }

/// A button with a name for scripts.
bool named_button(Ui& ui, const std::string& name, const char* label, bool lit = false);
/// In a list that is open.
void close_on_escape(const Ui& ui);
/// "1 contact", "2 contacts".
std::string counted(std::int64_t n, const std::string& what);
/// A number in few letters: `digits` of it, and of an exponent only what is needed.
std::string brief(double v, int digits = 2);
/// The text, shown while the pointer is over the item made last; lines broken at `chars` characters.
void tooltip(const std::string& text);

}  // namespace impinge
