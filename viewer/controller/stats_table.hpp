// stats.csv: its columns, and the same figures as numbers for `expect` and `break`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/world/step_record.hpp"

namespace impinge {

/// What a frame's row says beside the model's own figures.
struct FrameExtras {
  double render_ms = 0.0;
  double judged_penetration = 0.0;  ///< metres; with --judge, as is the next
  std::int64_t judged_intersections = 0;
};

/// The header line, without line end; `judged`: with the columns of --judge, which come last.
std::string stats_header(bool judged);
/// A frame's line, without line end; numbers in their shortest form that reads back exactly.
std::string stats_row(const FrameStats& stats, const FrameExtras& extras, bool judged);

/// The columns that are numbers (all but state_hash), in order, and a frame's values for them.
const std::vector<std::string>& figure_names(bool judged);
std::vector<double> figure_values(const FrameStats& stats, const FrameExtras& extras, bool judged);

/// Throws DivergenceError with frame and column where a figure is not finite: such a row is not written.
void check_figures(const FrameStats& stats, const FrameExtras& extras, bool judged);

/// What a line of stats.csv says. Throws InputError on a line of another shape.
struct StatsLine {
  std::vector<double> figures;
  std::string state_hash;
};
StatsLine parse_stats_row(std::string_view line, bool judged);

}  // namespace impinge
