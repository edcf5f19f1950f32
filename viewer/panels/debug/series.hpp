// What the timeline plots: a column of stats.csv, or a figure of a body or a pair of bodies, over the frames.
#pragma once

#include <functional>
#include <string>

#include "viewer/draw/number_text.hpp"
#include "viewer/state/debug_model.hpp"

namespace impinge {

struct Series {
  std::string name, unit;
  std::function<double(int frame)> value;  ///< NaN: there is none
  /// Counts as they are, what has a unit with its prefix.
  NumberText text(double value) const;
};

/// What that word of a `panel plot` stands for. It refers to the model.
Series series_of(const DebugModel& model, const std::string& name);
/// All that is plotted, by frame, as a table: frame, time_s and a column each; no number where there is none.
std::string plots_csv(const DebugModel& model);

}  // namespace impinge
