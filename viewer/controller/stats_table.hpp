// stats.csv: its columns, and the same figures as numbers for `expect` and `break`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/world/step_record.hpp"

namespace impinge {

/// The header line, without line end.
std::string stats_header();
/// A frame's line, without line end; numbers in their shortest form that reads back exactly.
std::string stats_row(const FrameStats& stats, double render_ms);

/// The columns that are numbers (all but state_hash), in order, and a frame's values for them.
const std::vector<std::string>& figure_names();
std::vector<double> figure_values(const FrameStats& stats, double render_ms);

/// What a line of stats.csv says. Throws InputError on a line of another shape.
struct StatsLine {
  std::vector<double> figures;
  std::string state_hash;
};
StatsLine parse_stats_row(std::string_view line);

}  // namespace impinge
