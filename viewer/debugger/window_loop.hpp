// The debugger on screens: a window of the desktop, browsers, or several at once, with the same pixels and one queue of
// input.
#pragma once

#include <atomic>
#include <functional>
#include <span>

#include "viewer/debugger/loop.hpp"
#include "viewer/present/screen.hpp"

namespace impinge {

/// Shows the debugger until one of the screens is closed, it quits or is interrupted; plays no faster than the scene's own
/// time. `now_and_then` is called every few seconds.
void show_on_screens(DebugLoop& loop, DebugWindow& pixels, std::span<const std::unique_ptr<Screen>> screens,
                     const std::atomic<bool>& interrupted, const std::function<void()>& now_and_then);

}  // namespace impinge
