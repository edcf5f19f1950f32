// Ctrl-C or SIGTERM. The first is answered by a line on stderr at once and raises a flag that the model looks at; a
// program that has not ended within a limit by then, because it stands in a long stage of a library, is ended: what
// lies on the disk is whole at any moment. The second ends the program at once. Exit code 130 each time.
#pragma once

#include <atomic>

namespace impinge {

/// From now on. Once, at the start, before any other thread: the signals are blocked in all of them and awaited by one.
void watch_for_interrupt();
/// What the line says that the program does about it. `what` must stay there for good.
void explain_interrupt(const char* what);
/// How long the program has to end by itself, seconds; 1.3 unless said. Less than the 2 s that are promised.
void limit_interrupt(double seconds);
/// Raised by the first.
const std::atomic<bool>& interrupted();

}  // namespace impinge
