// What the panels of the debugger are made of, beside Dear ImGui's own.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <optional>
#include <string>

#include "viewer/draw/palette.hpp"
#include "viewer/panels/debug/panel.hpp"

namespace impinge {

inline ImVec4 dim() { return ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled); }

/// A button with a name for scripts.
bool named_button(Ui& ui, const std::string& name, const char* label, bool lit = false);
/// A line as wide as the panel for the words that what is below has to have; where they were changed, the new ones.
std::optional<std::string> search_field(Ui& ui, const std::string& name, const std::string& now);
/// In a list that is open.
void close_on_escape(const Ui& ui);
/// "1 contact", "2 contacts".
std::string counted(std::int64_t n, const std::string& what);
/// A number in few letters: `digits` of it, and of an exponent only what is needed.
std::string brief(double v, int digits = 2);
/// The text, shown while the pointer is over the item made last; lines broken at `chars` characters.
void tooltip(const std::string& text);

}  // namespace impinge
