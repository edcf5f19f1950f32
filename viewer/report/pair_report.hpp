// What became of a pair of bodies, for reading and for programs.
#pragma once

#include <string>

#include "engine/world/pair_watch.hpp"

namespace impinge {

/// What was looked at: frames 0 to `last`, and the verdict in the watch, which must have one.
std::string pair_text(const PairWatch& watch, int last_frame);
/// One JSON object with a line end; numbers in their shortest form that reads back exactly.
std::string pair_json(const PairWatch& watch, int last_frame);

}  // namespace impinge
