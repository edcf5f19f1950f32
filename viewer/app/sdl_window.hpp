// A window of the desktop that shows the debugger's pixels and hands its input on. Nothing else knows a window system.
#pragma once

#include <atomic>
#include <functional>

#include "viewer/controller/debug_loop.hpp"

namespace impinge {

/// Whether there is a screen that a window can be opened on.
bool has_screen();

/// `now_and_then` is called every few seconds.
/// Shows the debugger until it is closed, quits or is interrupted; plays no faster than the scene's own time. Throws
/// InputError where no window can be had.
void show_window(DebugLoop& loop, DebugWindow& window, const std::string& title, const std::atomic<bool>& interrupted,
                 const std::function<void()>& now_and_then);

}  // namespace impinge
