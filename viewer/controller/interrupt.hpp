// Ctrl-C or SIGTERM: the first asks to stop where that loses nothing, the second ends the program at once.
#pragma once

#include <atomic>

namespace impinge {

void watch_for_interrupt();
const std::atomic<bool>& interrupted();

}  // namespace impinge
