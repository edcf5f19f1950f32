// A table of one figure over two parameters, each cell in the colour of its value and with the value in it.
#pragma once

#include <string>
#include <vector>

#include "viewer/panels/overlay/overlay.hpp"

namespace impinge {

struct HeatTable {
  std::string title, row_label, column_label, value_label;  ///< value_label with its unit
  std::vector<std::string> rows, columns;                   ///< their heads
  std::vector<double> values;                               ///< row by row; NaN: none
  /// as many; what a cell without a value says, or adds to it
  std::vector<std::string> notes;
  std::vector<bool> doubtful{};  ///< as many, or none: crossed in a corner
};

/// Fills the whole picture: dark on white. The colours go by the logarithm where all values are positive and spread
/// widely.
void draw_heat_table(const Pen& pen, const HeatTable& table);

}  // namespace impinge
