// The debugger in a window of the desktop.
#pragma once

#include <atomic>
#include <functional>

#include "viewer/debugger/loop.hpp"

namespace impinge {

/// Shows the debugger until it is closed, quits or is interrupted; plays no faster than the scene's own time.
/// `now_and_then` is called every few seconds. Throws InputError where no window can be had.
void show_window(DebugLoop& loop, DebugWindow& pixels, const std::string& title, const std::atomic<bool>& interrupted,
                 const std::function<void()>& now_and_then);

}  // namespace impinge
