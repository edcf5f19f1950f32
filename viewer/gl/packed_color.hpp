// Colours as Dear ImGui's draw lists take them.
#pragma once

#include <imgui.h>

#include "viewer/draw/palette.hpp"

namespace impinge {

inline ImU32 packed(Color c) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, c.a}); }
inline ImU32 opaque(Color c) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1.0f}); }

}  // namespace impinge
