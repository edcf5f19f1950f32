// A plot with logarithmic axes (or x in equal steps), drawn with a pen: what it shows as data, and how it looks.
#pragma once

#include <string>
#include <vector>

#include "engine/core/types.hpp"
#include "viewer/panels/overlay/overlay.hpp"

namespace impinge {

struct PlotSeries {
  std::string name;          ///< a '-' before a letter may become a line break in the legend
  std::vector<Vec2> points;  ///< in order; what isn't finite or positive breaks the line
};

struct Plot {
  std::string title, x_label, y_label;  ///< labels with their units
  std::vector<PlotSeries> series;
  /// x counts from 0, which a logarithmic axis doesn't have: 0 stands apart at its left end.
  bool x_counts = false;
  bool x_linear = false;         ///< x from 0 on, in equal steps
  bool marks_all = false;        ///< a mark at every point, however close
  std::vector<Vec2> best{};      ///< ringed, and joined by a dashed front
  std::string best_label{};      ///< what that means, below the legend
  std::vector<Vec2> doubtful{};  ///< crossed out: no mark of a series is a cross
  std::string doubtful_label{};  ///< likewise
};

/// Fills the whole picture: dark on white, a colour and a kind of mark a series, colours after Okabe & Ito.
void draw_plot(const Pen& pen, const Plot& plot);

}  // namespace impinge
