// ledger.csv: a row for each body that had an entry in the frame, and one for all of them, named *.
#pragma once

#include <span>
#include <string>

#include "engine/ledger/frame_ledger.hpp"

namespace impinge {

/// Of each body: what the two ends of the frame measure, energy by source and the closing error, J; then momentum,
/// kg·m/s, and angular momentum about the origin, kg·m²/s, by source, and what they leave open.
std::string ledger_header();
/// All lines of a frame, each with its line end.
std::string ledger_rows(const FrameLedger& ledger, int frame, double time, std::span<const std::string> names);

}  // namespace impinge
