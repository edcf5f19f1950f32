// What a browser says of its mouse and keys: lines of text, one event each.
#pragma once

#include <optional>
#include <string_view>

#include "viewer/panels/debug/ui.hpp"

namespace impinge {

/// `move X Y`, `press BUTTON`, `release BUTTON`, `wheel DY`, `down KEY`, `up KEY`, `type TEXT`; buttons and keys as
/// button_names() and key_names() have them, pixels of the window. Nothing for anything else: whoever says that is no
/// page of ours.
std::optional<UiEvent> parse_web_event(std::string_view line, int width, int height);

}  // namespace impinge
